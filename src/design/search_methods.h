#pragma once

#include <functional>

#include "design/foresight.h"
#include "design/run.h"
#include "design/scene.h"
#include "design/target.h"
#include "optim/least_squares.h"
#include "optim/outcome.h"

namespace catoptric::design {

/// The objective as searches ask for it: answers are remembered where the control has a tape, and an
/// evaluation that the user broke off has no value: infinity, which is not remembered. Where the control says
/// that evaluations are shared, ranks compute what `rehearse` finds will be asked for next.
/// @in    all but `rung` and `rehearse` outlive the result
optim::Problem light_problem(const Scene& scene, sim::Rung rung, const Target& target,
                             const SceneFamily& family, const RunControl& control,
                             Foresight::Rehearse rehearse = {});

/// One search with one kernel, restarts included.
optim::Outcome search_once(const Scene& scene, sim::Rung rung, const Target& target,
                           const RunControl& control);

/// Why Levenberg-Marquardt cannot search here.
/// @fails InputError saying so
void require_fit(const Scene& scene, sim::Rung rung);

/// The field's deviations at the samples as a least-squares problem over the scene's variables, by ray tubes
/// and their derivatives; its norm is the scene's objective. Where a mirror breaks
/// constraints there is no value, so that a fit which begins within them stays there.
/// @in    require_fit holds; scene and target outlive the result
/// @cost  512 samples of the paper's scene: 0.3 ms, with derivatives 1 ms
optim::LeastSquaresProblem fit_problem(const Scene& scene, const Target& target);

}  // namespace catoptric::design
