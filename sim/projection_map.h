#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/profile.h"
#include "base/ray.h"
#include "sim/cosine_law.h"

namespace catoptric::sim {

/// What a source is for its projection map: a flat disc across its axis, a point, or a ball that holds the
/// source, whose every part shines by the same law about the axis.
struct Emitter {
  Vector3 center_mm;
  double radius_mm = 0;
  CosineLaw law = {};
  Vector3 axis = Vector3::UnitZ();  ///< unit; of no meaning where the law is even
  bool is_flat = true;              ///< a disc; else a ball
};

/// The directions from a source that may meet the mirror, the brighter ones the oftener; photons are sent
/// nowhere else. Never leaves out a lit direction in which any point of the source meets the mirror.
///
/// The directions are bands in the cosine of the polar angle, each with arcs of azimuth. About a source's own
/// axis brightness depends on that cosine alone, so that the light of a band is (integral over the cosine)
/// times (azimuth width): two uniform numbers map to it without waste, nothing is rejected, and evenly spread
/// numbers stay even.
/// @from  Jensen & Christensen 1995; paper section 4.4
class ProjectionMap {
 public:
  /// All directions.
  static ProjectionMap whole_sphere();

  /// All directions that a source lights.
  static ProjectionMap all_lit(const Emitter& emitter);

  /// From a source on the axis that shines alike round it: the union of intervals in the cosine of the polar
  /// angle that the generatrix covers, with at most 0.5 % waste, and the full azimuth. From any other: cells
  /// of equal light in the cone that holds the mirror, each kept when a piece of the mirror may be seen in
  /// it. From a source on the mirror, or one that does not light it: all that it lights.
  /// @cost  under 0.3 ms on the axis, some ms off it
  static ProjectionMap towards(const Profile& profile, const Emitter& emitter);
  static ProjectionMap towards(const Profile& profile, const Vector3& source_mm) {
    return towards(profile, Emitter{source_mm});
  }

  double solid_angle_sr() const { return solid_angle_sr_; }

  /// Brightness in the map's directions together over that along the source's axis; the solid angle where
  /// the law is even.
  double light_sr() const { return light_sr_; }

  /// Maps the unit square to the directions, areas in proportion to light: `first` runs through the bands
  /// (stretched over the gaps between them), `second` through the band's azimuth.
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

  /// Whether any direction of the map may lie within an angle of this one: never false where one does.
  /// @in    half_angle_rad below pi / 2
  bool touches(const Vector3& direction, double half_angle_rad) const;

 private:
  struct Arc {
    double first_rad, length_rad;
  };
  struct Band {
    double low, high;  ///< cosine of the polar angle
    double before_sr;  ///< light of the bands before this one
    double width_rad;  ///< sum of the arcs
    double from;       ///< the law's integral at `low`
    std::vector<Arc> arcs;
  };
  explicit ProjectionMap(const CosineLaw& law) : law_(law) {}
  void add_band(double low, double high, std::vector<Arc> arcs);
  static ProjectionMap from_axis(const Profile& profile, const Emitter& emitter);
  static ProjectionMap from_aside(const Profile& profile, const Emitter& emitter);

  CosineLaw law_;
  std::vector<Band> bands_;
  double solid_angle_sr_ = 0, light_sr_ = 0;
  Eigen::Matrix3d frame_ = Eigen::Matrix3d::Identity();  ///< columns: two axes of azimuth, the polar axis
};

}  // namespace catoptric::sim
