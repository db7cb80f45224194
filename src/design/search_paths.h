#pragma once

#include <vector>

#include "design/run.h"

namespace catoptric::design {

/// The scene's search from its own start and from each of `landscape.starts`.
/// @in    scene  its landscape asks for paths
/// @fails InputError where a start makes no mirror or the method does not allow the scene; Error when stopped
std::vector<SearchPath> search_paths(const Scene& scene, const Target& target, const RunControl& control);

}  // namespace catoptric::design
