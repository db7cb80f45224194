#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/profile.h"
#include "base/ray.h"

namespace catoptric::sim {

/// The directions from a point source that may meet the mirror; photons are sent nowhere else. Never leaves
/// out a direction that meets the mirror.
///
/// The directions are bands in the cosine of the polar angle, each with arcs of azimuth, so that area on the
/// unit sphere is (cosine width) times (azimuth width) and two uniform numbers map to it without waste.
/// @from  Jensen & Christensen 1995; paper section 4.4
class ProjectionMap {
 public:
  /// All directions.
  static ProjectionMap whole_sphere();

  /// From a source on the axis: the union of intervals in the cosine of the polar angle that the generatrix
  /// covers, with at most 0.5 % waste, and the full azimuth. From a source off the axis: equal-area cells of
  /// the cone that holds the mirror, each kept when a piece of the mirror may be seen in it. From a source on
  /// the mirror: the whole sphere.
  /// @cost  under 0.3 ms on the axis, some ms off it
  static ProjectionMap towards(const Profile& profile, const Vector3& source_mm);

  double solid_angle_sr() const { return solid_angle_sr_; }

  /// Maps the unit square to the directions, areas in proportion: `first` runs through the bands (stretched
  /// over the gaps between them), `second` through the band's azimuth.
  /// @in    numbers in [0, 1)
  /// @out   a unit vector
  Vector3 direction(double first, double second) const;

  /// The cosines of the polar angle that `direction` gives for these first numbers, many at a time, for a map
  /// about the axis: all of its azimuths belong to it, so that the second number is the azimuth in turns.
  /// @in    about_axis(); numbers in [0, 1), as many as cosines
  void cosines(std::span<const double> first, std::span<double> cosines) const;

  /// Whether the polar axis is z and every band full: from a source on the axis, and for the whole sphere.
  bool about_axis() const;

  /// Whether the direction belongs to the map, borders included.
  bool contains(const Vector3& direction) const;

 private:
  struct Arc {
    double first_rad, length_rad;
  };
  struct Band {
    double low, high;  ///< cosine of the polar angle
    double before_sr;  ///< solid angle of the bands before this one
    double width_rad;  ///< sum of the arcs
    std::vector<Arc> arcs;
  };
  ProjectionMap() = default;
  void add_band(double low, double high, std::vector<Arc> arcs);
  static ProjectionMap from_axis(const Profile& profile, double source_z_mm);
  static ProjectionMap from_aside(const Profile& profile, const Vector3& source_mm);

  std::vector<Band> bands_;
  double solid_angle_sr_ = 0;
  Eigen::Matrix3d frame_ = Eigen::Matrix3d::Identity();  ///< columns: two axes of azimuth, the polar axis
};

}  // namespace catoptric::sim
