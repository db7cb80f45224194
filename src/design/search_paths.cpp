#include "design/search_paths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <string_view>

#include "base/errors.h"
#include "design/constraints.h"
#include "design/evaluator.h"
#include "design/metrics.h"
#include "design/search.h"
#include "design/shared_work.h"

namespace catoptric::design {
namespace {

/// Where the landscape's variables stand in the design vector.
std::vector<std::size_t> places_of(const Scene& scene) {
  std::vector<std::size_t> places;
  for (const std::string& name : scene.landscape->variables)
    for (std::size_t i = 0; i < scene.variables.size(); ++i)
      if (scene.variables[i].name == name) places.push_back(i);
  return places;
}

std::vector<double> picked(const std::vector<double>& x, const std::vector<std::size_t>& places) {
  std::vector<double> point;
  for (const std::size_t place : places) point.push_back(x[place]);
  return point;
}

/// A, B ... Z, then numbers.
std::string name_of(std::size_t start) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";
  return start < letters.size() ? std::string(1, letters[start]) : fmt::format("{}", start + 1);
}

std::string in_words(const std::vector<double>& point) {
  return fmt::format("({:.4g})", fmt::join(point, ", "));
}

SearchPath path_of(const std::string& name, const Scene& scene, const optim::Outcome& outcome,
                   const std::vector<std::size_t>& places) {
  SearchPath path{name, {}, {}, {}, {}};
  for (const optim::Iterate& each : outcome.history) {
    std::vector<double> point = picked(each.x, places);
    if (!path.points.empty() && path.points.back() == point) continue;
    path.points.push_back(std::move(point));
    path.values.push_back(each.value < infeasible_floor ? each.value
                                                        : std::numeric_limits<double>::quiet_NaN());
  }
  const std::string start = in_words(picked(starts(scene.variables), places));
  const std::string end = in_words(picked(outcome.best, places));
  path.label = name + ": " + start + " to " + end;
  path.ending =
      fmt::format("{}, {} {:.4g} after {} evaluations, {}", path.label, objective_name(scene.search.metric),
                  outcome.value, outcome.evaluations, outcome.sentence);
  return path;
}

/// The scene with its landscape's variables at another start.
Scene begun_at(const Scene& scene, const std::vector<double>& start, const std::vector<std::size_t>& places) {
  Scene moved = scene;
  for (std::size_t i = 0; i < places.size(); ++i) moved.variables[places[i]].start = start[i];
  if (!family_of(moved).at(starts(moved.variables)))
    throw scene.settings.error("landscape.starts", in_words(start) + " makes no mirror",
                               "the generatrix must stay in the half-plane r >= 0", "move the start");
  return moved;
}

}  // namespace

std::vector<SearchPath> search_paths(const Scene& scene, const Target& target, const RunControl& control) {
  const std::vector<std::size_t> places = places_of(scene);
  const sim::Rung rung = make_plan(scene, family_of(scene)).rung;
  std::vector<Scene> begun{scene};
  for (const auto& start : scene.landscape->starts) begun.push_back(begun_at(scene, start, places));
  std::vector<SearchPath> paths;
  const auto searched = ranks_of(control).share(begun.size(), [&](std::size_t i) {
    const SearchPath path = path_of(name_of(i), begun[i], search(begun[i], rung, target, control), places);
    if (control.stopped()) throw Interrupted();
    return as_bytes(path);
  });
  for (const Bytes& path : searched) paths.push_back(search_path_of(path));
  return paths;
}

}  // namespace catoptric::design
