#pragma once

#include <cstdint>
#include <vector>

#include "base/planar_hits.h"
#include "sim/material.h"
#include "sim/opening.h"

namespace catoptric::sim {

/// Where light of one emission angle meets the near field's plane, on the side that is asked for, after it
/// has touched the mirror.
struct Landing {
  double rho_mm;            ///< signed radius
  double slope_mm_per_rad;  ///< its derivative by the emission angle
  double weight;            ///< product of the reflectances and transmittances on the way
  std::uint64_t path;       ///< names the surfaces met, in order; equal for neighbours on one smooth branch
};

/// What became of a ray of weight 1 besides its landings.
struct Dropped {
  double faint = 0;      ///< weight of paths given up, which may have landed
  double cut_off = 0;    ///< weight of paths stopped after the most interactions
  int interactions = 0;  ///< with the mirror, on all paths
};

/// The plane across the axis on which light is registered.
struct FieldPlane {
  double z_mm;
  bool looks_up;  ///< whether light counts that comes from above, against a normal of +z
};

/// Follows rays from a point on the axis through their meridian plane, with the derivative of the ray by its
/// emission angle: the perpendicular distance to the neighbouring ray and its turn, both per radian.
/// @from  differential ray tracing in two dimensions: transfer y += L a; at a curve with curvature k the foot
///        of the neighbour lies s = y / (t . n) farther, its normal is turned by k s, so a' = 2 k s - a
class TubeTracer {
 public:
  struct Limits {
    int most_interactions;
    double least_weight;  ///< a path that splits is given up below this
  };
  /// @in mirror: specular
  TubeTracer(const Profile& profile, double source_z_mm, const FieldPlane& plane, const Material& mirror,
             const Limits& limits);

  /// Appends the landings of the ray that leaves at `theta_rad` from +z towards positive radius.
  /// @cost  one intersection per interaction, and one more where the mirror has no opening
  Dropped trace(double theta_rad, std::vector<Landing>& landings) const;

  const PlanarMirror& section() const { return section_; }

 private:
  struct Path;
  void follow(Path path, std::vector<Landing>& landings, Dropped& dropped) const;
  std::uint64_t surface_of(const PlanarHit& hit) const;
  void land(const Path& path, double reach_mm, std::vector<Landing>& landings) const;

  PlanarMirror section_;
  double source_z_mm_;
  FieldPlane plane_;
  Material mirror_;
  Limits limits_;
  double lift_mm_;
  std::optional<Opening> opening_;  ///< what leaves through it is asked of no intersection
  std::vector<std::uint64_t>
      smooth_run_;                  ///< of each span: spans joined with a common tangent share a number
  std::vector<bool> through_axis_;  ///< of each run: whether it goes on smoothly on the other side
};

}  // namespace catoptric::sim
