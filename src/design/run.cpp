#include "design/run.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "base/byte_record.h"
#include "base/errors.h"
#include "design/brief.h"
#include "design/design_space.h"
#include "design/evaluator.h"
#include "design/memory_need.h"
#include "design/metrics.h"
#include "design/search.h"
#include "design/search_paths.h"
#include "design/shared_work.h"
#include "design/stage.h"
#include "design/variables.h"

namespace catoptric::design {
namespace {

constexpr std::uint64_t verdict_stream = 1;

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

void need_target(const Scene& scene, const char* command) {
  if (scene.target.kind == TargetKind::none)
    throw scene.settings.error("target.kind", "there is nothing to aim at",
                               std::string(command) + " compares the light with a target",
                               "target.kind = \"uniform\" with radius and irradiance, or another kind");
}

std::uint64_t emitted(const Judgement& judgement) {
  return judgement.far_photons +
         (judgement.accuracy ? judgement.accuracy->spent_photons : judgement.photons * judgement.replicates);
}

/// Shows how near an accuracy is, and stops with what there is when the user wants to.
std::function<bool(std::uint64_t, double)> watch_accuracy(const Scene& scene, const RunControl& control,
                                                          const char* phase) {
  return [&control, phase, asked_rel = *scene.accuracy_rel](std::uint64_t photons, double error95_rel) {
    const double share = std::isfinite(error95_rel) ? std::min(1.0, asked_rel / error95_rel) : 0.0;
    control.tell({phase, share * share, std::numeric_limits<double>::quiet_NaN(),
                  0,  // error falls like 1 / sqrt
                  fmt::format("{} photons: relative error at most {:.2g}", photons, error95_rel)});
    return !control.stopped();
  };
}

/// The dearest rung that a corner of the landscape needs.
sim::Rung rung_for(const Scene& scene, const LandscapeSpec& spec, const SceneFamily& family,
                   const Candidate& start) {
  sim::Rung rung = make_plan(scene, start).rung;
  for (const auto* corner : {&spec.lower, &spec.upper})
    if (const auto candidate = family.at(*corner)) rung = std::max(rung, make_plan(scene, *candidate).rung);
  return rung;
}

/// A verdict by fresh photons; by few of them once the user has stopped the run.
Judgement verdict(const Scene& scene, const Target& target, const Candidate& candidate,
                  const RunControl& control) {
  try {
    if (!stopped_for_all(control)) return judge(scene, target, candidate, sim::Rung::photons, verdict_stream);
  } catch (const Interrupted&) {
  }
  const InBrief brief = in_brief(scene, target);
  return judge(brief.scene, brief.target, candidate, sim::Rung::photons, verdict_stream);
}

}  // namespace

SceneFamily family_of(const Scene& scene) {
  return {scene.with(scene.profile), shape_family(scene), names(scene.variables), scene.unit,
          scene.opening_mm};
}

Profile start_profile(const Scene& scene) { return start_candidate(scene).profile; }

Candidate start_candidate(const Scene& scene) {
  auto candidate = family_of(scene).at(starts(scene.variables));
  if (!candidate)
    throw scene.settings.error("variables." + scene.variables.front().name + ".start",
                               "the start values make no mirror",
                               "the generatrix must stay in the half-plane r >= 0", "move the start values");
  return std::move(*candidate);
}

DesignResult run_design(const Scene& given, const RunControl& control) {
  const Scene scene = controlled(given, control);
  if (scene.variables.empty() && scene.search.method != "none")
    throw scene.settings.error("variables", "there is nothing to search",
                               "design moves at least one variable",
                               "[variables.w1] with step, lower and upper");
  need_target(scene, "design");
  require_memory(scene, ranks_of(scene).size(), ranks_of(scene).size_here());
  const Candidate start = start_candidate(scene);
  const SceneFamily family = family_of(scene);
  sim::Plan plan = make_plan(scene, family);
  const Stopwatch watch;
  Target target = make_target(scene);
  require_metric(scene, target);
  RefinedOutcome found = search_in_stages(
      scene, [&](const Scene& stage) { return search_by_ranks(stage, plan.rung, target, control); });
  const optim::Outcome& outcome = found.outcome;
  const double search_seconds = of_first(ranks_of(control), watch.seconds());
  const Candidate best = family_of(found.last).at(outcome.best).value_or(start);
  control.tell({"verify", 1.0, outcome.value < infeasible_floor ? outcome.value : NAN, outcome.evaluations});
  Judgement start_judgement = verdict(scene, target, start, control);
  Judgement best_judgement =
      scene.accuracy_rel
          ? judge_to_accuracy(shared(given, control), make_sharp_target(shared(given, control)), best,
                              verdict_stream, true, watch_accuracy(scene, control, "verify"))
          : verdict(scene, target, best, control);
  std::uint64_t photons = emitted(start_judgement) + emitted(best_judgement);
  if (plan.rung != sim::Rung::tubes)
    photons += scene.model.photons.photons * static_cast<std::uint64_t>(outcome.evaluations);
  return {std::move(target),
          std::move(plan),
          outcome,
          {start.profile, starts(scene.variables), std::move(start_judgement),
           states(scene.constraints, start.profile), start.source, names(scene.variables)},
          {best.profile, outcome.best, std::move(best_judgement), states(scene.constraints, best.profile),
           best.source, names(found.last.variables)},
          photons,
          search_seconds,
          of_first(ranks_of(control), watch.seconds()),
          std::move(found.stages)};
}

sim::Plan simulation_plan(const Scene& scene, const Candidate& candidate) {
  if (!scene.accuracy_rel) return make_plan(scene, candidate);
  const Stage stage(scene, candidate);
  sim::ModelRequest request = model_request(scene);
  request.estimate = {};
  return sim::make_plan(stage.scene, request);
}

SimulationResult run_simulation(const Scene& given, const RunControl& control) {
  const Scene scene = shared(given, control);
  require_memory(scene, ranks_of(scene).size(), ranks_of(scene).size_here());
  const Stopwatch watch;
  const Candidate start = start_candidate(scene);
  sim::Plan plan = simulation_plan(scene, start);
  Target target = scene.accuracy_rel ? make_sharp_target(scene) : make_target(scene);
  if (!target.irradiance_w_per_mm2.empty()) require_metric(scene, target);
  control.tell({"simulate", 0.0, std::numeric_limits<double>::quiet_NaN(), 0});
  Judgement judgement = scene.accuracy_rel
                            ? judge_to_accuracy(scene, target, start, verdict_stream, false,
                                                watch_accuracy(scene, control, "simulate"))
                            : judge(stoppable(scene, control.stop), target, start, plan.rung, verdict_stream);
  const std::uint64_t photons = emitted(judgement);
  return {std::move(target),
          std::move(plan),
          {start.profile, starts(scene.variables), std::move(judgement),
           states(scene.constraints, start.profile), start.source, names(scene.variables)},
          photons,
          of_first(ranks_of(control), watch.seconds())};
}

Landscape run_landscape(const Scene& given, const RunControl& control) {
  const Scene scene = controlled(given, control);
  need_target(scene, "landscape");
  if (!scene.landscape)
    throw scene.settings.error("landscape.variables", "is missing", "landscape needs one or two variables",
                               "landscape.variables = [\"w1\", \"r2\"] with lower, upper and steps");
  require_memory(scene, ranks_of(scene).size(), ranks_of(scene).size_here());
  const Stopwatch watch;
  const LandscapeSpec& spec = *scene.landscape;
  Landscape result{spec.variables, {}, {}, {}, 0};
  for (std::size_t i = 0; i < spec.variables.size(); ++i) {
    std::vector<double> axis;
    for (int j = 0; j < spec.steps[i]; ++j)
      axis.push_back(spec.lower[i] + (spec.upper[i] - spec.lower[i]) * j / (spec.steps[i] - 1));
    result.axes.push_back(axis);
  }
  const Target target = make_target(scene);
  require_metric(scene, target);
  if (spec.paths) result.paths = search_paths(scene, target, control);
  // Everything that is not drawn stays at its start.
  const Candidate start = start_candidate(scene);
  const Candidate whole = *family_of(scene).whole_at(starts(scene.variables));
  const SceneFamily family(whole, spec.variables, scene.unit, scene.opening_mm);
  const sim::Rung rung = rung_for(scene, spec, family, start);
  const std::vector<double> once{0.0};
  const std::vector<double>& second = result.axes.size() > 1 ? result.axes[1] : once;
  const std::size_t points = result.axes[0].size() * second.size();
  double best = std::numeric_limits<double>::quiet_NaN();
  const auto value = [&](std::size_t i) {
    if (control.stopped()) throw Interrupted();
    std::vector<double> x{result.axes[0][i / second.size()]};
    if (result.axes.size() > 1) x.push_back(second[i % second.size()]);
    return ByteWriter().put(value_at(scene, rung, target, family, x)).take();
  };
  const auto take = [&](std::size_t i, const Bytes& bytes) {
    const auto found = ByteReader(bytes).get<double>();
    const bool allowed = found < infeasible_floor;
    result.objective.push_back(allowed ? found : std::numeric_limits<double>::quiet_NaN());
    if (allowed && (std::isnan(best) || found < best)) best = found;
    control.tell({"landscape", static_cast<double>(i + 1) / static_cast<double>(points), best,
                  static_cast<long>(i + 1)});
  };
  const Bytes all =
      ranks_of(control).join(points, value, take, [&] { return ByteWriter().put(result.objective).take(); });
  ByteReader(all).get(result.objective);
  result.seconds = watch.seconds();
  return result;
}

}  // namespace catoptric::design
