#include <catch2/catch.hpp>

#include "base/units.h"
#include "design/stage.h"
#include "sim/simulation.h"

/// Cases of photometry with known numbers, from the scene file on.

using namespace catoptric;
using namespace catoptric::design;

namespace {

/// A scene in metres with a mirror that takes no part.
Scene scene(const std::string& source) {
  return make_scene(
      Settings::parse("unit = \"m\"\nreflector.points = [[0, 9], [0.001, 9], [0.002, 8.999]]\n"
                      "reflector.reflectance = 0\nnear_field.radius = 6\n" +
                          source,
                      "test.toml", scene_keys()));
}

double lux_at(const Scene& scene, double x_m) {
  const Stage stage(scene, scene.profile);
  const std::vector<sim::FieldSample> place{{{1000 * x_m, 0, 0}, {0, 0, 1}}};
  return to_w_per_m2(sim::direct_field(stage.scene, place).front());
}

}  // namespace

// The case of a point source of 10,000 lm alike in all directions 3 m above a floor. A table of it goes round
// under the name of CIE 171:2006 (88.42, 75.45, 52.15, 31.83, 19.10, 11.68 lx at 0 to 5 m); its first and
// fifth numbers are the inverse square law's, the others are off by up to 3.1 %, and no light of a point can
// have them all.
TEST_CASE("a point source of 10,000 lm lights a floor 3 m below by the inverse square law") {
  const Scene lamp = scene("source.flux = 10000\nsource.position = [0, 0, 3]\n");
  CHECK(irradiance_unit(lamp.source.quantity) == "lx");
  const double by_law_lx[] = {88.4194, 75.4938, 50.9327, 31.2610, 19.0986, 12.0418};
  const double in_circulation_lx[] = {88.42, 75.45, 52.15, 31.83, 19.10, 11.68};
  for (int x_m = 0; x_m <= 5; ++x_m) {
    CHECK(lux_at(lamp, x_m) == Approx(by_law_lx[x_m]).margin(0.00006).epsilon(0));
    CHECK(lux_at(lamp, x_m) == Approx(in_circulation_lx[x_m]).epsilon(x_m == 0 || x_m == 4 ? 0.0001 : 0.032));
  }
}

// A disc of radius R at height h over its axis' foot gives exitance R^2 / (R^2 + h^2); a square of side 2 a
// over its middle's foot the well known arctangents.  @from Howell, catalogue of configuration factors B-12,
// B-5
TEST_CASE("panels of 1,000 lm light the floor below as their configuration factors say") {
  const double exitance_disc = 1000 / (pi * 0.25), exitance_square = 1000;
  const Scene disc = scene(
      "source.kind = \"disc\"\nsource.radius = 0.5\nsource.flux = 1000\nsource.position = [0, 0, 2]\n"
      "source.axis = [0, 0, -1]\n");
  CHECK(lux_at(disc, 0) == Approx(exitance_disc * 0.25 / (0.25 + 4)).epsilon(1e-12));
  const Scene square = scene(
      "source.kind = \"rectangle\"\nsource.width = 1\nsource.height = 1\nsource.flux = 1000\n"
      "source.position = [0, 0, 2]\nsource.axis = [0, 0, -1]\n");
  const double side = 0.5 / std::hypot(0.5, 2.0);
  CHECK(lux_at(square, 0) == Approx(exitance_square * 4 / pi * side * std::atan(side)).epsilon(1e-12));
}
