#include <catch2/catch.hpp>
#include <cmath>

#include "base/errors.h"
#include "base/units.h"
#include "design/luminaire.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

IntensityTable triangle(double reach_deg) {
  std::vector<double> gamma, values;
  for (int i = 0; i <= 180; ++i) {
    gamma.push_back(i);
    values.push_back(std::max(0.0, 100 * (1 - i / reach_deg)));
  }
  return {LightQuantity::luminous, gamma, {0}, values};
}

Scene scene(const std::string& more) {
  return make_scene(
      Settings::parse("unit = \"cm\"\nreflector.points = [[0, 10], [5, 10], [10, 5]]\n"
                      "near_field.radius = 5\nmodel.photons = 20000\nmodel.replicates = 4\n" +
                          more,
                      "test.toml", scene_keys()));
}

}  // namespace

TEST_CASE("beam and field angle are where the interpolant falls to a half and a tenth") {
  const BeamAngle angle = beam_angle(triangle(40), 0);
  CHECK(*angle.half_deg == Approx(40));
  CHECK(*angle.tenth_deg == Approx(72));
  const IntensityTable aside(LightQuantity::luminous, {0, 90, 180}, {0, 180}, {10, 10, 10, 10, 0, 0});
  CHECK_FALSE(beam_angle(aside, 0).half_deg);
}

TEST_CASE("the paper's paraboloid throws half of the light down the axis, and the rest goes straight") {
  const LuminaireIntensity found =
      run_intensity(scene("source.flux = 1000\nsource.position = [0, 0, 5]\n"), {});
  CHECK(found.beam == Vector3(0, 0, -1));
  CHECK(found.table.is_rotational());
  CHECK(found.flux.value == Approx(1000).epsilon(1e-12));
  CHECK(found.peak_gamma_deg == 0);
  CHECK(found.table.quantity() == LightQuantity::luminous);
  REQUIRE(found.zones.size() > 2);
  double all = 0;
  for (const ZonalFlux& zone : found.zones) all += zone.flux.value;
  CHECK(all == Approx(1000).epsilon(1e-6));
  // To 30 degrees: the beam, and the source's own cone.
  CHECK(found.zones.front().flux.value == Approx(500 + 500 * (1 - std::cos(pi / 6))).epsilon(0.01));
  CHECK(found.photons == 80'000);
  CHECK(*found.angles.front().half_deg < 2);
  // Parallel light has no intensity: the table's is that of its steps, and the run says so.
  CHECK(found.bias_rel > 0.5);
  CHECK_THAT(found.remark, Catch::Contains("gamma_step"));
}

TEST_CASE("a lamp off the axis has an intensity by both angles, and losses show in its flux") {
  const LuminaireIntensity found =
      run_intensity(scene("source.power = 2\nsource.position = [1, 0, 5]\nreflector.reflectance = 0.5\n"
                          "intensity.c_step = 30\nintensity.gamma_step = 5\n"),
                    {});
  CHECK(found.table.c_deg().size() == 12);
  CHECK(found.angles.size() == 2);
  CHECK(found.flux.value < 1.6);
  CHECK(found.flux.value > 1.3);
  CHECK(found.noise_rel > 0);
  CHECK(
      run_intensity(
          scene("source.power = 2\nsource.kind = \"disc\"\nsource.radius = 2\nsource.position = [0, 0, 5]\n"),
          {})
          .remark.empty());
  CHECK_THROWS_WITH(run_intensity(scene("source.power = 2\nmodel.photons = 0\n"), {}),
                    Catch::Contains("model.photons"));
}
