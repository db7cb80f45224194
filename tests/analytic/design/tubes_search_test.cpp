#include <catch2/catch.hpp>

#include "design/run.h"

using namespace catoptric;
using namespace catoptric::design;

TEST_CASE("a search with ray tubes finds the paraboloid, and photons it never saw confirm it") {
  const Scene scene =
      read_scene(std::string(CATOPTRIC_DATA) + "/paper/start_a.toml", {{"model.rung", "tubes", "test"},
                                                                       {"model.photons", "20000", "test"},
                                                                       {"model.replicates", "2", "test"}});
  const DesignResult result = run_design(scene, {});
  CHECK(result.plan.rung == sim::Rung::tubes);
  CHECK(result.best.variables[0] == Approx(1).margin(0.001));  // two of the last steps
  CHECK(result.best.variables[1] == Approx(10).margin(0.004));
  CHECK(result.search.value < 0.001);
  CHECK(result.photons == 20000 * 2 * 2);  // for the two verdicts alone
  // the verdict holds the photons' own noise, which the search's objective does not
  CHECK(result.best.judgement.objective.value > result.search.value);
  CHECK(result.best.judgement.objective.value - result.best.judgement.objective.bias < 0.003);
}
