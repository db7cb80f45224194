#include "design/refinement.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/profile_limits.h"
#include "cad/refine.h"
#include "design/design_space.h"
#include "design/run.h"
#include "design/search.h"
#include "optim/stages.h"

namespace catoptric::design {
namespace {

/// A refined mirror is near its best: large steps would be wasted.
constexpr double step_reduction = 0.25;

/// The scene that searches on from `profile`.
Scene next_scene(const Scene& scene, const Scene& last, Profile profile, const optim::Outcome& so_far) {
  Scene next = last;
  next.profile = std::move(profile);
  next.search.free_profile.length_step_rel *= step_reduction;
  next.search.free_profile.log_weight_step *= step_reduction;
  std::vector<optim::Variable> beside = last.variables;  // the shape's have other names from now on
  std::erase_if(beside, [](const auto& each) { return !parse_scene_variable(each.name); });
  for (optim::Variable& each : beside) {
    const auto place = std::find_if(last.variables.begin(), last.variables.end(),
                                    [&](const auto& other) { return other.name == each.name; });
    each.start = so_far.best[static_cast<std::size_t>(place - last.variables.begin())];
  }
  next.variables = free_variables(next.profile, next.search, beside);
  next.search.most_evaluations = scene.search.most_evaluations - so_far.evaluations;
  next.search.most_iterations = scene.search.most_iterations - so_far.iterations;
  return next;
}

bool may_go_on(const RefinedOutcome& found, const Scene& scene) {
  const optim::Outcome& outcome = found.outcome;
  return outcome.ending == optim::Ending::converged && outcome.evaluations < scene.search.most_evaluations &&
         outcome.iterations < scene.search.most_iterations;
}

}  // namespace

Profile refined(const Profile& profile, const std::string& step) {
  const auto space = step.find(' ');
  const std::string word = step.substr(0, space);
  int number = 0;
  const char* end = step.data() + step.size();
  const auto read = space == std::string::npos ? std::from_chars_result{end, std::errc::invalid_argument}
                                               : std::from_chars(step.data() + space + 1, end, number);
  if (read.ec != std::errc{} || read.ptr != end || (word != "degree" && word != "spans"))
    throw InputError({fmt::format("\"{}\" is no refinement", step), "",
                      "a step is \"degree N\" or \"spans N\"", "[\"degree 3\", \"spans 2\", \"spans 4\"]"});
  if (word == "degree") {
    if (number <= profile.degree())
      throw InputError({fmt::format("\"{}\" gives no freedom", step), "",
                        fmt::format("the generatrix has degree {} by then", profile.degree()), ""});
    return cad::elevated(profile, number);
  }
  const int spans = static_cast<int>(profile.spans().size());
  if (number <= spans || number % spans != 0)
    throw InputError({fmt::format("\"{}\" does not cut all spans alike", step), "",
                      fmt::format("the generatrix has {} by then: a multiple of that is needed", spans),
                      fmt::format("\"spans {}\"", 2 * spans)});
  if (static_cast<std::size_t>(number) > most_control_points)
    throw InputError({fmt::format("\"{}\" makes too many control points", step), "",
                      fmt::format("a generatrix has at most {}", most_control_points), "fewer spans"});
  return cad::split_spans(profile, number / spans);
}

RefinedOutcome search_in_stages(const Scene& scene,
                                const std::function<optim::Outcome(const Scene&)>& search) {
  RefinedOutcome found{search(scene), scene, {}};
  const auto note = [&](const std::string& step, long before) {
    const std::size_t points = found.last.profile.points().size();
    found.stages.push_back(
        {step, points, found.last.variables.size(), found.outcome.evaluations - before, found.outcome.value});
  };
  note("", 0);
  for (const std::string& step : scene.search.refine) {
    const auto best = family_of(found.last).whole_at(found.outcome.best);
    if (!best || !may_go_on(found, scene)) break;
    Scene next = next_scene(scene, found.last, refined(best->profile, step), found.outcome);
    const long before = found.outcome.evaluations;
    optim::Outcome stage = search(next);
    if (!stage.history.empty()) stage.history.front().move = step;
    optim::append(found.outcome, std::move(stage));
    found.last = std::move(next);
    note(step, before);
  }
  return found;
}

}  // namespace catoptric::design
