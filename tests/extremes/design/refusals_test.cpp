#include <catch2/catch.hpp>

#include "design/run.h"
#include "design/sensitivity.h"
#include "support/ladder_scenes.h"
#include "support/scaled_scene.h"

/// What cannot be right is refused in words that name the key; what is merely odd works.
using namespace catoptric;
using namespace catoptric::design;
using Catch::Contains;

namespace {

Scene scene(const std::string& text, const test::Keys& keys = {}) {
  return test::scene_of(test::scaled_text(text, 1), keys);
}

const std::string lamp = R"(
[source]
position = [0, 0, 50]
power = 1
[near_field]
radius = 50
samples = 20
[model]
photons = 500
replicates = 3
)";

std::string with_mirror(const std::string& more) {
  return lamp + "[reflector]\npoints = [[0, 100], [50, 100], [100, 50]]\n" + more;
}

void design_is_refused(const std::string& text, const test::Keys& keys, const std::string& part) {
  INFO(part);
  CHECK_THROWS_WITH(run_design(scene(text, keys), {}), Contains(part));
}

}  // namespace

TEST_CASE("weights too far apart for one span are refused, also of a target", "[extremes]") {
  CHECK_THROWS_WITH(scene(with_mirror("weights = [1e8, 1, 1e-8]\n")),
                    Contains("reflector.weights") && Contains("act on one span"));
  CHECK_THROWS_WITH(scene(with_mirror("weights = [1.1e6, 1, 1]\n")), Contains("differ by 1.1e+06"));
  const Scene allowed = scene(with_mirror("weights = [1, 1, 1]\n"));
  const SceneFamily family(allowed.with(allowed.profile), std::vector<std::string>{"w1"}, allowed.unit);
  CHECK(family.at(std::array{0.9e6}));  // nor does a search go there
  CHECK_FALSE(family.at(std::array{1.1e6}));
  CHECK_FALSE(family.at(std::array{0.9e-6}));
  CHECK_NOTHROW(scene(with_mirror("weights = [1e6, 1, 1]\n")));
  CHECK_THROWS_WITH(scene(with_mirror("[target]\nkind = \"reflector\"\npoints = [[0, 100], [50, 100], [100, "
                                      "50]]\nweights = [1e-8, 1, 1e8]\n")),
                    Contains("target.weights"));
}

TEST_CASE("a verdict without photons, or with kernels that hold none, is refused", "[extremes]") {
  const auto simulate = [](const test::Keys& keys) {
    return run_simulation(scene(with_mirror(""), keys), {});
  };
  CHECK_THROWS_WITH(simulate({{"model.rung", "photons"}, {"model.photons", "0"}}),
                    Contains("model.photons") && Contains("no photon is sent"));
  CHECK_THROWS_WITH(simulate({{"model.rung", "photons"}, {"model.kernel_radius", "1e-6"}}),
                    Contains("model.kernel_radius") && Contains("no sample sees"));
  CHECK_NOTHROW(simulate({{"model.rung", "tubes"}, {"model.photons", "0"}}));
  // A black mirror's field is dark, and rightly so.
  CHECK_NOTHROW(simulate({{"model.rung", "photons"}, {"reflector.reflectance", "0"}}));
}

TEST_CASE("targets out of reach are named before anything is searched", "[extremes]") {
  const test::Keys far_too_much{{"target.irradiance", "600"}};
  design_is_refused(test::nothing_scene, far_too_much, "source.power");
  design_is_refused(test::nothing_scene, {{"source.position", "[5, 0, 0]"}}, "source.position");
  design_is_refused(test::nothing_scene, {{"reflector.reflectance", "0"}}, "reflector.reflectance");
  design_is_refused(test::nothing_scene, {{"near_field.normal", "[0, 0, -1]"}}, "near_field.normal");
}

TEST_CASE("searches with the least budget, without room, or that no mirror satisfies end in words",
          "[extremes]") {
  const test::Keys few{{"model.photons", "300"}, {"near_field.samples", "20"}};
  const auto designed = [&](test::Keys keys) {
    keys.insert(keys.end(), few.begin(), few.end());
    return run_design(scene(test::paper_scene, keys), {});
  };
  CHECK_THROWS_WITH(scene(test::paper_scene, {{"search.most_evaluations", "0"}}),
                    Contains("search.most_evaluations"));
  for (const char* method :
       {"hooke-jeeves", "levenberg-marquardt", "nelder-mead", "compass", "cma-es", "differential-evolution",
        "self-adaptive-de", "particle-swarm", "simulated-annealing", "genetic"}) {
    INFO(method);
    const DesignResult one = designed({{"search.method", method}, {"search.most_evaluations", "1"}});
    CHECK(one.search.evaluations == 1);
    CHECK(one.search.value == one.search.start_value);
    CHECK_FALSE(one.search.sentence.empty());
  }
  const DesignResult none =
      designed({{"constraints.rim_radius_max", "1e-3"}, {"search.most_evaluations", "30"}});
  CHECK(sentence(none.best.constraints, LengthUnit::millimetre).find("not satisfied") != std::string::npos);
}

TEST_CASE("sensitivity of a dark field is refused, of no modes and a black mirror works", "[extremes]") {
  const test::Keys plain{{"sensitivity.modes", "0"}, {"near_field.samples", "20"}};
  CHECK_NOTHROW(run_sensitivity(scene(test::paper_scene, plain), {}));
  const Sensitivity black = run_sensitivity(
      scene(test::paper_scene, {{"sensitivity.modes", "0"}, {"reflector.reflectance", "0"}}), {});
  // Its shadow may still matter, what it reflects does not.
  for (const ParameterSensitivity& each : black.parameters) CHECK(each.deviation.key != "reflectance");
  CHECK_THROWS_WITH(run_sensitivity(scene(test::paper_scene, {{"near_field.normal", "[0, 0, -1]"},
                                                              {"reflector.reflectance", "0"}}),
                                    {}),
                    Contains("dark"));
}
