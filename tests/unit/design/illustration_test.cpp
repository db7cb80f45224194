#include "design/illustration.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace catoptric;
using namespace catoptric::design;

namespace {

Scene scene(const std::string& more) {
  return make_scene(
      Settings::parse("unit = \"cm\"\nsource.power = 1\nsource.position = [0, 0, 5]\n"
                      "reflector.points = [[0, 10], [5, 10], [10, 5]]\nnear_field.radius = 5\n"
                      "near_field.samples = 60\nmodel.photons = 4000\nmodel.replicates = 2\n"
                      "sensitivity.modes = 0\n" +
                          more,
                      "test.toml", scene_keys()));
}

const std::string search =
    "target.kind = \"paraboloid\"\ntarget.focal_length = 5\nmodel.kernel_radius = 0.5\n"
    "search.smallest_step = 0.1\nvariables.w1 = {start = 1.6, step = 0.5, lower = 0.05, upper = 20}\n";

}  // namespace

TEST_CASE("rays of the paraboloid go from its focus to the mirror and down beside the axis") {
  const auto paths = shown_paths(scene(""));
  REQUIRE(paths.size() == 24);
  for (const sim::LightPath& path : paths) {
    REQUIRE(path.corners_mm.size() == 2);
    CHECK(path.corners_mm[0] == Vector3(0, 0, 50));
    const Vector3& turn = path.corners_mm[1];
    CHECK(turn.z() == Approx(100 - std::pow(turn.head<2>().norm(), 2) / 200));
    REQUIRE(path.landed_mm);  // those that miss the field are not wanted while there are others
    CHECK((*path.landed_mm - Vector3(turn.x(), turn.y(), 0)).norm() < 1e-7);
  }
}

TEST_CASE("a design by tubes over one variable has its landscape about the path, within the bounds",
          "[long]") {
  const Scene given = scene(search);
  const DesignResult result = run_design(given, {});
  const Illustration shown = illustrate(given, result);
  REQUIRE(shown.landscape);
  REQUIRE(shown.landscape->paths.size() == 1);
  const auto& axis = shown.landscape->axes[0];
  CHECK(axis.front() >= 0.05);
  for (const auto& point : shown.landscape->paths[0].points) {
    CHECK(point[0] > axis.front());
    CHECK(point[0] < axis.back());
  }
  REQUIRE(shown.intensity);
  CHECK(shown.intensity->profile == result.best.profile);
  REQUIRE(shown.sensitivity);
  CHECK(shown.left_out.empty());
}

TEST_CASE("what a report leaves out is said, and is no error") {
  const Scene given = scene(search + "model.rung = \"photons\"\n");
  const Illustration shown = illustrate(given, run_design(given, {}));
  CHECK_FALSE(shown.landscape);
  CHECK_FALSE(shown.sensitivity);
  REQUIRE(shown.left_out.size() == 2);
  CHECK_THAT(shown.left_out[0], Catch::Contains("catoptric sensitivity"));
  CHECK_THAT(shown.left_out[1], Catch::Contains("catoptric landscape"));
}
