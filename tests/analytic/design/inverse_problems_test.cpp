#include <catch2/catch.hpp>

#include "design/run.h"

/// Problems next door to a mirror's design (paper section 7): what the light of a known mirror tells of its
/// source.

using namespace catoptric;
using namespace catoptric::design;

namespace {

Scene example(const char* name, std::vector<Override> overrides = {}) {
  overrides.push_back({"model.photons", "20000", "test"});
  overrides.push_back({"model.replicates", "2", "test"});
  return read_scene(std::string(CATOPTRIC_DATA) + "/examples/" + name, overrides);
}

}  // namespace

TEST_CASE("place, power and reflectance are found from the light of a known mirror") {
  const DesignResult result = run_design(example("find_source.toml"), {});
  CHECK(result.plan.rung == sim::Rung::tubes);
  REQUIRE(result.best.variables.size() == 3);
  CHECK(result.best.variables[0] == Approx(48).margin(0.001));
  CHECK(result.best.variables[1] == Approx(10).margin(0.001));
  CHECK(result.best.variables[2] == Approx(0.8).margin(0.0001));
  // the verdict is that of the source found, not of the one in the file
  CHECK(result.best.source.position_mm.z() == Approx(48).margin(0.001));
  CHECK(result.start.source.position_mm.z() == 53);
  CHECK(result.start.judgement.objective.value > 50 * result.best.judgement.objective.value);
}

TEST_CASE("without direct light power and reflectance are one: the light is met, not the truth") {
  // the near field stands above the source and looks up: no light comes straight to it
  const Scene scene =
      example("find_source.toml", {{"near_field.center", "[0, 0, 49.5]", "test"},
                                   {"near_field.radius", "40", "test"},
                                   {"variables.source.z.lower", "47.9999", "test"},
                                   {"variables.source.z.start", "48", "test"},
                                   {"variables.source.z.upper", "48.0001", "test"},
                                   {"variables.source.power.start", "15", "test"},
                                   {"variables.reflector.reflectance.start", "0.61", "test"}});
  const DesignResult result = run_design(scene, {});
  const double power = result.best.variables[1], reflectance = result.best.variables[2];
  CHECK(power * reflectance == Approx(8).epsilon(1e-3));
  CHECK(std::abs(power - 10) > 0.1);
}

TEST_CASE("place, power and exponent of a source are found from the light of a known mirror") {
  const DesignResult result = run_design(example("find_beam.toml"), {});
  CHECK(result.best.variables[0] == Approx(48).margin(0.001));
  CHECK(result.best.variables[1] == Approx(10).margin(0.001));
  CHECK(result.best.variables[2] == Approx(1.5).margin(0.001));
  CHECK(result.best.source.exponent == result.best.variables[2]);
}

TEST_CASE("a source that may leave the axis is searched by photons in space, and a landscape as well") {
  const Scene scene =
      example("find_beam.toml", {{"variables.source.x.start", "0", "test"},
                                 {"variables.source.x.step", "1", "test"},
                                 {"variables.source.x.lower", "0", "test"},
                                 {"variables.source.x.upper", "5", "test"},
                                 {"near_field.samples", "40", "test"},
                                 {"search.most_evaluations", "3", "test"},
                                 {"landscape.variables", "[\"source.x\", \"source.z\"]", "test"},
                                 {"landscape.lower", "[0, 45]", "test"},
                                 {"landscape.upper", "[4, 51]", "test"},
                                 {"landscape.steps", "[2, 3]", "test"}});
  CHECK(run_design(scene, {}).plan.rung == sim::Rung::photons);
  const Landscape landscape = run_landscape(scene, {});
  REQUIRE(landscape.objective.size() == 6);
  for (const double value : landscape.objective) CHECK(value > 0);
  CHECK(landscape.objective[0] != landscape.objective[3]);  // the source does move
}
