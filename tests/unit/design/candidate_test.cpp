#include "design/candidate.h"

#include <catch2/catch.hpp>

#include "design/design_space.h"
#include "design/run.h"
#include "design/search.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

Scene scene_with(std::vector<Override> changes) {
  for (const char* part : {".step", ".lower", ".upper"}) {
    const std::string value = std::string(part) == ".upper" ? "7" : "1";
    changes.push_back({std::string("variables.source.z") + part, value, "test"});
  }
  return read_scene(std::string(CATOPTRIC_DATA) + "/paper/start_a.toml", changes);
}

std::vector<double> shape_part(const Scene& scene, const std::vector<double>& x) {
  std::vector<double> part;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!parse_scene_variable(scene.variables[i].name)) part.push_back(x[i]);
  return part;
}

}  // namespace

TEST_CASE("each kind of shape moves beside the source, whatever the variables' order", "[candidate]") {
  for (const char* free : {"\"listed\"", "\"profile\"", "\"curvature\""}) {
    INFO(free);
    Scene scene = scene_with({{"search.free", free, "test"}});
    REQUIRE(scene.variables.back().name == "source.z");
    std::rotate(scene.variables.begin() + 1, scene.variables.end() - 1, scene.variables.end());
    std::vector<double> x = starts(scene.variables);
    x[0] *= 1.01;
    x[1] = 5.5;
    x.back() *= 0.98;
    const SceneFamily family = family_of(scene);
    CHECK(family.scene_places() == std::vector<std::size_t>{1});
    const auto candidate = family.at(x);
    REQUIRE(candidate);
    CHECK(candidate->source.position_mm == Vector3(0, 0, 55));
    CHECK(candidate->source.power_w == scene.source.power_w);
    const auto alone =
        std::visit([&](const auto& each) { return each.at(shape_part(scene, x)); }, shape_family(scene));
    REQUIRE(alone);
    CHECK(candidate->profile == *alone);
    CHECK_FALSE(candidate->profile == family.base().profile);
  }
}

TEST_CASE("a free shape begins at the scene's, its listed variables at their starts", "[candidate]") {
  for (const char* free : {"\"profile\"", "\"curvature\""}) {
    INFO(free);
    const Scene scene = scene_with({{"search.free", free, "test"}, {"variables.w1.start", "1.3", "test"}});
    CHECK(scene.profile.points()[1].weight == 1.3);
    const auto candidate = family_of(scene).at(starts(scene.variables));
    REQUIRE(candidate);
    for (const double share : {0.0, 0.3, 0.7, 1.0}) {
      // at other speeds along the curve: radii are compared by the height they have
      const MeridianPoint p = candidate->profile.at(share);
      double nearest = HUGE_VAL;
      for (int i = 0; i <= 2000; ++i) {
        const MeridianPoint q = scene.profile.at(i / 2000.0);
        nearest = std::min(nearest, std::hypot(p.r_mm - q.r_mm, p.z_mm - q.z_mm));
      }
      CHECK(nearest < 0.1);
    }
  }
}

TEST_CASE("values that make no mirror or no source make no candidate", "[candidate]") {
  const Scene scene = scene_with({{"search.free", "\"profile\"", "test"},
                                  {"variables.reflector.reflectance.step", "0.1", "test"},
                                  {"variables.reflector.reflectance.lower", "0.5", "test"},
                                  {"variables.reflector.reflectance.upper", "1", "test"}});
  const SceneFamily family = family_of(scene);
  std::vector<double> x = starts(scene.variables);
  CHECK(family.at(x));
  x.back() = 1.1;
  CHECK_FALSE(family.at(x));
  x.back() = 0.9;
  REQUIRE(family.at(x));
  CHECK(family.at(x)->mirror.reflectance == 0.9);
  x[3] = -20;  // r2, far across the axis
  REQUIRE(scene.variables[3].name == "r2");
  CHECK_FALSE(family.at(x));
}

TEST_CASE("step and bounds of listed components are a free profile's, weights by their logarithm",
          "[candidate]") {
  const Scene scene = scene_with({{"search.free", "\"profile\"", "test"}});
  const auto named = [&](const std::string& name) {
    for (const optim::Variable& each : scene.variables)
      if (each.name == name) return each;
    FAIL(name << " is missing");
    return optim::Variable{};
  };
  CHECK(named("logw1").lower == Approx(std::log(0.05)));
  CHECK(named("logw1").upper == Approx(std::log(20)));
  CHECK(named("logw1").step == Approx(std::log((1.6 + 0.5) / 1.6)));
  CHECK(named("r2").step == 1);
  CHECK(named("r2").upper == 30);
  CHECK(named("r1").step != 1);
}
