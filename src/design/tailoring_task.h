#pragma once

#include <string>
#include <vector>

#include "design/flux_map.h"
#include "design/radial_target.h"
#include "design/scene.h"
#include "design/tailored_curve.h"

namespace catoptric::design {

/// What a tailored mirror of a scene has to do.
struct TailoringTask {
  AxialLayout layout;
  PolarFlux flux;  ///< of the source, taken for a point
  FluxMap map;
  WantedLight wanted;  ///< from the mirror: the target less the direct light
  std::function<double(double radius_mm)> total_w_per_mm2;  ///< the target at its level, 0 beyond its end
  double level;                                             ///< factor on the target's irradiance
  double unreachable_rel;
  std::vector<std::string> notes;
};

/// @in    apex_side: +1 where the mirror stands above its source
/// @fails InputError as tailored_from_nothing, but for the package
TailoringTask tailoring_task(const Scene& scene, double apex_side);

}  // namespace catoptric::design
