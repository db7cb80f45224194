#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "design/scene.h"

namespace catoptric::design {

/// What is wanted, where it depends on the distance from the axis alone.
struct RadialTarget {
  std::function<double(double radius_mm)>
      total_w_per_mm2;  ///< direct light included; at a jump the inner value
  std::vector<double>
      jumps_mm;      ///< radii at which it jumps, rising; the last is reach_mm unless it fades out there
  double reach_mm;   ///< the mirror is asked for no light beyond it
  bool dark_beyond;  ///< true: total is 0 beyond the reach; false: what the source sends there by itself
};

/// The scene's target as a function of the radius: uniform, ring, zones, gaussian, radial and paraboloid.
/// @out   nothing for reference reflectors and tables of points, which need not be functions of the radius
/// @from  paraboloid: paper eq. 12 and 13
std::optional<RadialTarget> radial_target(const Scene& scene);

}  // namespace catoptric::design
