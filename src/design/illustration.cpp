#include "design/illustration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/errors.h"
#include "design/constraints.h"
#include "design/designed_scene.h"
#include "design/evaluator.h"
#include "design/stage.h"

namespace catoptric::design {
namespace {

/// Streams that nothing else uses.
constexpr std::uint64_t illustration_stream = std::uint64_t{1} << 39;
constexpr std::uint64_t traced_paths = 512;
constexpr std::size_t most_paths = 24;
constexpr std::uint64_t most_photons_from_afar = 32'768, most_replicates_from_afar = 4;
constexpr std::uint64_t most_photons_of_a_tolerance = 20'000, most_replicates_of_a_tolerance = 4;
constexpr const char* too_long_by_photons =
    "by photons it would take longer than the search; catoptric landscape draws it";
constexpr int landscape_steps = 21;
/// Light that turns more often makes ray tubes dear: of a cavity one evaluation may take a second.
constexpr double most_turns = 4;
constexpr double landscape_margin = 0.2;  ///< about the path, as a share of its extent

/// With less light, and by the engine that is quick.
Scene lightened(Scene scene, std::uint64_t photons, std::uint64_t replicates) {
  scene.model.engine = Engine::meridian;
  scene.model.engine_asked_for = false;
  scene.model.photons.photons = std::min(scene.model.photons.photons, photons);
  scene.model.replicates = std::min(scene.model.replicates, replicates);
  return scene;
}

/// Runs one part; what cannot be computed is no error of the run that it illustrates.
void attempt(Illustration& illustration, const std::string& what, const std::function<void()>& make) {
  try {
    make();
  } catch (const Error& error) {
    illustration.left_out.push_back(fmt::format("{}: {}", what, error.what()));
  }
}

std::vector<sim::LightPath> traced(const Scene& given) {
  const Scene scene = lightened(given, traced_paths, 1);
  const Stage stage(scene, start_candidate(scene));
  sim::PhotonOptions photons = scene.model.photons;
  photons.photons = traced_paths;
  photons.seed = scene.seed;
  photons.stream = illustration_stream + 1;
  return light_paths(stage.scene, photons);
}

/// How often light that has met the mirror turns on its way, on average.
double mean_turns(const std::vector<sim::LightPath>& paths) {
  std::size_t met = 0, turns = 0;
  for (const sim::LightPath& path : paths) {
    if (!path.met_mirror) continue;
    ++met;
    turns += path.corners_mm.size() - 1;
  }
  return met > 0 ? static_cast<double>(turns) / static_cast<double>(met) : 0.0;
}

std::vector<sim::LightPath> shown(std::vector<sim::LightPath> all) {
  std::erase_if(all, [](const sim::LightPath& path) { return !path.met_mirror; });
  // What arrives is what the mirror is for; what misses stands in where too little does.
  std::stable_partition(all.begin(), all.end(),
                        [](const sim::LightPath& path) { return path.landed_mm.has_value(); });
  all.resize(std::min(all.size(), most_paths));
  return all;
}

/// The path of a search over its own variables; values are left out, for the landscape shows them.
SearchPath path_of(const optim::Outcome& outcome) {
  SearchPath path{"", "search", {}, {}, {}};
  for (const optim::Iterate& each : outcome.history) {
    if (!path.points.empty() && path.points.back() == each.x) continue;
    path.points.push_back(each.x);
    path.values.push_back(each.value < infeasible_floor ? each.value
                                                        : std::numeric_limits<double>::quiet_NaN());
  }
  return path;
}

/// About the path, within the variables' bounds.
LandscapeSpec window(const Scene& scene, const SearchPath& path) {
  LandscapeSpec spec{{}, {}, {}, {}, {}};
  for (std::size_t i = 0; i < scene.variables.size(); ++i) {
    const optim::Variable& variable = scene.variables[i];
    const auto [least, greatest] = std::minmax_element(
        path.points.begin(), path.points.end(), [i](const auto& a, const auto& b) { return a[i] < b[i]; });
    const double low = (*least)[i], high = (*greatest)[i];
    const double margin = std::max(landscape_margin * (high - low), variable.step);
    spec.variables.push_back(variable.name);
    spec.lower.push_back(std::max(variable.lower, low - margin));
    spec.upper.push_back(std::min(variable.upper, high + margin));
    spec.steps.push_back(landscape_steps);
  }
  return spec;
}

/// Why there is no landscape, or nothing.
std::string landscape_objection(const Scene& scene, const DesignResult& result) {
  if (scene.search.method == "none") return "nothing was searched";
  if (scene.search.free != Freedom::listed || scene.variables.size() > 2 || !scene.search.refine.empty())
    return "the search moved more than two variables";
  if (result.plan.rung != sim::Rung::tubes) return too_long_by_photons;
  const std::string& method = scene.search.method;
  const bool walks = method == "hooke-jeeves" || method == "nelder-mead" || method == "compass" ||
                     method == "levenberg-marquardt";
  if (!walks)
    return "the search drew mirrors from all of its box; catoptric landscape draws what is asked for";
  return {};
}

/// Whether ray tubes are valid at the corners of the window too.
bool is_for_tubes(const Scene& scene, const LandscapeSpec& spec) {
  const SceneFamily family = family_of(scene);
  for (const bool high_first : {false, true})
    for (const bool high_second : {false, true}) {
      std::vector<double> corner = high_first ? spec.upper : spec.lower;
      if (corner.size() > 1) corner[1] = (high_second ? spec.upper : spec.lower)[1];
      const auto candidate = family.at(corner);
      if (candidate && make_plan(scene, *candidate).rung != sim::Rung::tubes) return false;
    }
  return true;
}

void add_landscape(Illustration& illustration, const Scene& scene, const DesignResult& result) {
  const auto leave_out = [&](const std::string& why) {
    illustration.left_out.push_back("Landscape: " + why + ".");
  };
  if (const std::string why = landscape_objection(scene, result); !why.empty()) return leave_out(why);
  attempt(illustration, "Landscape", [&] {
    SearchPath path = path_of(result.search);
    // where tubes give up within the window, few photons stand in
    Scene drawn = lightened(scene, most_photons_of_a_tolerance, 1);
    drawn.landscape = window(scene, path);
    if (!is_for_tubes(scene, *drawn.landscape)) return leave_out(too_long_by_photons);
    Landscape found = run_landscape(drawn, {});
    const bool is_empty = std::none_of(found.objective.begin(), found.objective.end(),
                                       [](double value) { return std::isfinite(value); });
    if (is_empty) return leave_out("no mirror about the search's path keeps the constraints");
    found.paths = {std::move(path)};
    illustration.landscape = std::move(found);
  });
}

}  // namespace

std::vector<sim::LightPath> shown_paths(const Scene& scene) { return shown(traced(scene)); }

Illustration illustrate(const Scene& scene) {
  Illustration illustration;
  const Scene light = lightened(scene, most_photons_from_afar, most_replicates_from_afar);
  double turns = 0;
  attempt(illustration, "Rays", [&] {
    std::vector<sim::LightPath> paths = traced(scene);
    turns = mean_turns(paths);
    illustration.paths = shown(std::move(paths));
  });
  attempt(illustration, "Intensity", [&] { illustration.intensity = run_intensity(light, {}); });
  attempt(illustration, "Tolerances", [&] {
    const Scene brief = lightened(scene, most_photons_of_a_tolerance, most_replicates_of_a_tolerance);
    if (turns > most_turns)
      illustration.left_out.push_back(fmt::format(
          "Tolerances: light turns {:.1f} times in this mirror, and they would take longer than the run; "
          "catoptric sensitivity computes them.",
          turns));
    else if (make_plan(brief, start_candidate(brief)).rung == sim::Rung::tubes)
      illustration.sensitivity = run_sensitivity(brief, {});
    else
      illustration.left_out.emplace_back(
          "Tolerances: by photons they would take longer than the run; catoptric sensitivity computes them "
          "for scene.toml, or after a design for designed.toml.");
  });
  return illustration;
}

Illustration illustrate(const Scene& scene, const DesignResult& result) {
  Illustration illustration = illustrate(designed_scene(scene, result.best));
  add_landscape(illustration, scene, result);
  return illustration;
}

}  // namespace catoptric::design
