#include "design/search.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "design/brief.h"
#include "design/constraints.h"
#include "design/evaluator.h"
#include "design/far_field.h"
#include "design/metrics.h"
#include "design/search_methods.h"
#include "design/shared_work.h"
#include "optim/stages.h"

namespace catoptric::design {
namespace {

/// The scene with another kernel, beginning at x.
Scene with_kernel(const Scene& scene, double radius_mm, const std::vector<double>& x, long most_evaluations) {
  Scene stage = scene;
  stage.model.estimate.neighbours.reset();
  stage.model.estimate.kernel_radius_mm = radius_mm;
  stage.search.most_evaluations = most_evaluations;
  for (std::size_t i = 0; i < x.size(); ++i) stage.variables[i].start = x[i];
  return stage;
}

/// Adds a stage to those before, each of its moves with its kernel's name.
void append_kernel(optim::Outcome& all, optim::Outcome stage, const std::string& kernel) {
  for (optim::Iterate& each : stage.history) each.move += ", " + kernel;
  optim::append(all, std::move(stage));
}

/// A wide kernel shows few local minima, so each stage ends near the next one's best.
/// @from graduated optimization: Blake & Zisserman 1987
optim::Outcome search_coarse_to_fine(const Scene& scene, sim::Rung rung, const Target& target,
                                     const RunControl& control) {
  const SceneFamily family = family_of(scene);
  optim::Outcome all{};
  all.best = starts(scene.variables);
  all.start_value = light_problem(scene, rung, target, family, control).evaluate(all.best);
  all.evaluations = 1;
  const std::vector<double> start = all.best;
  const std::size_t stages = scene.search.kernels_mm.size() + 1;
  for (std::size_t i = 0; i < stages && !control.stopped(); ++i) {
    const bool last = i + 1 == stages;
    const long left = scene.search.most_evaluations - all.evaluations;
    const long share = std::max(1L, left / static_cast<long>(stages - i));
    if (last) {
      Scene stage = scene;
      stage.search.most_evaluations = share;
      for (std::size_t j = 0; j < all.best.size(); ++j) stage.variables[j].start = all.best[j];
      append_kernel(all, search_once(stage, rung, target, control), "own kernel");
    } else {
      const Scene stage = with_kernel(scene, scene.search.kernels_mm[i], all.best, share);
      append_kernel(all, search_once(stage, rung, blurred_target(stage), control),
                    fmt::format("kernel {:.6g} {}", scene.to_scene_unit(scene.search.kernels_mm[i]),
                                symbol(scene.unit)));
    }
  }
  if (control.stopped()) {  // in whatever stage: its value is no figure of this scene
    const InBrief brief = in_brief(scene, target);
    all.ending = optim::Ending::stopped;
    all.sentence = "stopped on request";
    all.value = value_at(brief.scene, rung, brief.target, family, all.best);
    all.start_value = value_at(brief.scene, rung, brief.target, family, start);
  }
  if (!(all.value <= all.start_value)) {
    all.best = start;
    all.value = all.start_value;
    all.sentence += "; all of it worse than the start";
  }
  return all;
}

/// No search: what there is, judged.
optim::Outcome as_it_starts(const Scene& scene, sim::Rung rung, const Target& target,
                            const RunControl& control) {
  optim::Outcome outcome{};
  outcome.ending = optim::Ending::converged;
  outcome.sentence = "not searched: the mirror is judged as it starts";
  outcome.best = starts(scene.variables);
  const SceneFamily family = family_of(scene);
  outcome.value = outcome.start_value =
      light_problem(scene, rung, target, family, control).evaluate(outcome.best);
  outcome.evaluations = 1;
  outcome.history.push_back({0, 0, 1, 1, "start", outcome.best, outcome.value});
  return outcome;
}

/// @fails InputError as search()
optim::Outcome search_by_method(const Scene& scene, sim::Rung rung, const Target& target,
                                const RunControl& control) {
  if (scene.search.method == "none") return as_it_starts(scene, rung, target, control);
  if (scene.search.method == "levenberg-marquardt") require_fit(scene, rung);
  const long kernels = static_cast<long>(scene.search.kernels_mm.size());
  if (kernels > 0 && scene.search.most_evaluations <= kernels + 1)
    throw scene.settings.error("search.most_evaluations", "leaves nothing for each kernel",
                               "every kernel needs evaluations of its own",
                               "fewer search.kernels, or more evaluations");
  if (kernels > 0) return search_coarse_to_fine(scene, rung, target, control);
  return search_once(scene, rung, target, control);
}

}  // namespace

std::vector<std::string> names(const std::vector<optim::Variable>& variables) {
  std::vector<std::string> list;
  for (const auto& variable : variables) list.push_back(variable.name);
  return list;
}

std::vector<double> starts(const std::vector<optim::Variable>& variables) {
  std::vector<double> list;
  for (const auto& variable : variables) list.push_back(variable.start);
  return list;
}

double value_at(const Scene& scene, sim::Rung rung, const Target& target, const SceneFamily& family,
                std::span<const double> x) {
  const auto candidate = family.at(x);
  if (!candidate) return std::numeric_limits<double>::infinity();
  if (const double broken = violation(scene.constraints, candidate->profile); broken > 0)
    return infeasible_objective(broken);
  if (is_of_intensity(scene.search.metric))
    return objective(target.far->scene, intensity_by_rung(*target.far, rung, *candidate, search_stream),
                     target.far->target);
  const std::vector<double> total = total_by_rung(scene, rung, *candidate, target.samples, search_stream);
  if (candidate->source.power_w == scene.source.power_w) return objective(scene, total, target);
  Scene powered = scene;  // a share of the power is a share of this candidate's
  powered.source = candidate->source;
  return objective(powered, total, target);
}

optim::Outcome search(const Scene& scene, sim::Rung rung, const Target& target, const RunControl& control) {
  optim::Outcome outcome = search_by_method(scene, rung, target, control);
  // A library that was told nothing at its first evaluation cannot know why.
  if (control.stopped() && !std::isfinite(outcome.value)) {
    outcome.ending = optim::Ending::stopped;
    outcome.sentence = "stopped on request before there was a value";
  }
  return outcome;
}

optim::Outcome search_by_ranks(const Scene& scene, sim::Rung rung, const Target& target,
                               const RunControl& control) {
  Ranks& ranks = ranks_of(control);
  if (!shares_evaluations(scene, rung, ranks))
    return outcome_of(ranks.from_first([&] { return as_bytes(search(scene, rung, target, control)); }));
  std::atomic<bool> stopped = false;
  RunControl together = control;
  together.stop = &stopped;
  together.stopped_together = &stopped;
  return search(scene, rung, target, together);
}

}  // namespace catoptric::design
