#pragma once

#include <vector>

#include "design/scene.h"
#include "report/view_3d.h"
#include "sim/light_paths.h"

namespace catoptric::report {

/// A mirror with its source, the fields and some rays in space, in the scene's unit of length. Fields so far
/// away that the mirror beside them would be a speck are left out, and said.
View3d view_of(const design::Scene& scene, const Profile& profile, const design::SourceSpec& source,
               const std::vector<sim::LightPath>& paths);

}  // namespace catoptric::report
