#pragma once

#include <optional>
#include <vector>

#include "design/candidate.h"
#include "design/scene.h"
#include "design/settings.h"
#include "optim/problem.h"

namespace catoptric::design {

/// What `landscape` draws; nothing where the scene does not say.
/// @in    searched  what the scene's search moves
/// @fails InputError: bounds and counts that do not fit the variables; paths of searches that move others
std::optional<LandscapeSpec> landscape_settings(const Settings& settings, const Candidate& base,
                                                const std::vector<optim::Variable>& searched);

}  // namespace catoptric::design
