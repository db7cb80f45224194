#pragma once

#include <span>
#include <string>
#include <vector>

#include "design/run.h"
#include "design/scene.h"
#include "design/target.h"
#include "design/variables.h"
#include "optim/outcome.h"

namespace catoptric::design {

/// All evaluations of one search share this stream of photons; verdicts come from the ones after it.
inline constexpr std::uint64_t search_stream = 0;

std::vector<std::string> names(const std::vector<optim::Variable>& variables);
std::vector<double> starts(const std::vector<optim::Variable>& variables);

/// The objective of one design vector on the search's stream; infinity where no mirror can be built,
/// and from infeasible_floor on where it breaks constraints.
double value_at(const Scene& scene, sim::Rung rung, const Target& target, const SceneFamily& family,
                std::span<const double> x);

/// Looks for a better mirror by the scene's method, from its variables' start values: with restarts all over
/// the box, and from a wide kernel to the scene's own where it asks for these.
/// @out   value and start_value are the scene's objective with its own kernel; `best` is never worse than the
///        start by it. With kernels the history holds each stage's own objective and names the kernel
/// @fails InputError, before anything is computed, for a method that this scene does not allow
optim::Outcome search(const Scene& scene, sim::Rung rung, const Target& target, const RunControl& control);

/// The same by all of the control's ranks: together where shares_evaluations(), else by rank 0 alone, and all
/// are told.
optim::Outcome search_by_ranks(const Scene& scene, sim::Rung rung, const Target& target,
                               const RunControl& control);

}  // namespace catoptric::design
