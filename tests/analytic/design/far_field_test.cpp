#include "design/far_field.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "design/judge.h"
#include "design/metrics.h"
#include "design/run.h"
#include "design/search.h"
#include "support/program.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::design;
using namespace catoptric::test;

namespace {

constexpr double power_w = 10, reflectance = 0.8;
/// What a point alone sends into every direction, W/sr.
const double alone = power_w / (4 * pi);
/// Its light comes back through it from a sphere about it: (1 + reflectance) times that, within the 60
/// degrees that the sphere reaches from the apex.
const double with_sphere = (1 + reflectance) * alone;

/// A point in the centre of a spherical mirror of 80 mm, shining downwards by way of it.
Scene sphere(const TemporaryFolder& folder, const std::string& rows, const std::string& more = "") {
  write_whole(folder / "wanted.csv", "angle,intensity\n" + rows);
  const double half = pi / 6, r = 80;
  const std::string text =
      "[source]\nposition = [0, 0, 0]\npower = " + std::to_string(power_w) +
      "\n[reflector]\nreflectance = " + std::to_string(reflectance) + "\npoints = [[0, 80], [" +
      std::to_string(r * std::tan(half)) + ", 80], [" + std::to_string(r * std::sin(2 * half)) + ", 40]]\n" +
      "weights = [1, " + std::to_string(std::cos(half)) + ", 1]\n" +
      "[near_field]\ncenter = [0, 0, -1000]\nradius = 500\nsamples = 200\n"
      "[model]\nphotons = 20000\nreplicates = 4\n"
      "[target]\nkind = \"uniform\"\nradius = 500\nirradiance = 1\nintensity_file = '" +
      (folder / "wanted.csv").string() + "'\n[search]\nmetric = \"intensity-rmse\"\n" + more;
  return make_scene(Settings::parse(text, "s.toml", scene_keys()));
}

std::string level(double intensity, double last_deg) {
  return "0," + std::to_string(intensity) + "\n" + std::to_string(last_deg) + "," +
         std::to_string(intensity) + "\n";
}

}  // namespace

TEST_CASE("a sphere about its source makes its intensity (1 + reflectance) times as large, by every rung",
          "[far_field]") {
  const TemporaryFolder folder;
  const Scene scene = sphere(folder, level(with_sphere, 50));
  const auto far = far_field(scene);
  REQUIRE(far);
  REQUIRE(far->target.samples.size() == 200);
  const Candidate candidate = start_candidate(scene);
  // a kernel of radius h raises or lowers irradiance like cos^3 by no more than 6 h^2 / 16
  const double blur = 6.0 / 16 * std::pow(pi / 90, 2);
  const std::vector<double> tubes = intensity_by_rung(*far, sim::Rung::tubes, candidate, 0);
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    CHECK(far->target.irradiance_w_per_mm2[i] == Approx(with_sphere).epsilon(blur));
    CHECK(tubes[i] == Approx(far->target.irradiance_w_per_mm2[i]).epsilon(1e-4));  // six digits of the scene
  }
  for (const sim::Rung rung : {sim::Rung::rings, sim::Rung::photons}) {
    INFO(sim::name(rung));
    double sum = 0;
    for (const double each : intensity_by_rung(*far, rung, candidate, 0)) sum += each / 200;
    CHECK(sum == Approx(with_sphere).epsilon(0.02));
    CHECK(sum != Approx(alone).epsilon(0.2));
  }
}

TEST_CASE("directions are even in solid angle, and what is wanted follows the table's angles",
          "[far_field]") {
  const TemporaryFolder folder;
  // the mirror's part is a ramp, which a kernel of 0.2 degrees does not change
  const Scene scene =
      sphere(folder, "0," + std::to_string(alone) + "\n60," + std::to_string(alone + 6) + "\n",
             "[variables.z0]\nstep = 1\nlower = 70\nupper = 90\n");
  Scene sharp = scene;
  sharp.target.resolution_rad = 0.2 * pi / 180;
  const auto far = far_field(sharp);
  int inside = 0;
  for (std::size_t i = 0; i < far->target.samples.size(); ++i) {
    const Vector3 way = (far->target.samples[i].point_mm - scene.source.position_mm).normalized();
    const double angle_deg = std::acos(-way.z()) * 180 / pi;
    inside += angle_deg < 30 ? 1 : 0;
    if (angle_deg > 1 && angle_deg < 59)
      CHECK(far->target.irradiance_w_per_mm2[i] == Approx(alone + angle_deg / 10).margin(2e-3));
  }
  const double share = (1 - std::cos(pi / 6)) / (1 - std::cos(pi / 3));
  CHECK(inside == Approx(200 * share).margin(1));
}

TEST_CASE("the metric is 0 for the right table, the difference for a wrong one, and photons agree",
          "[far_field]") {
  const TemporaryFolder folder;
  const auto searched = [&](const std::string& rows) {
    const Scene scene = sphere(folder, rows, "[variables.z0]\nstep = 1\nlower = 70\nupper = 90\n");
    return value_at(scene, sim::Rung::tubes, make_target(scene), family_of(scene), starts(scene.variables));
  };
  CHECK(searched(level(with_sphere, 50)) < 1e-4);
  CHECK(searched(level(alone, 50)) == Approx(reflectance * alone).epsilon(1e-3));

  const Scene scene = sphere(folder, level(alone, 50));
  const Judgement judged = judge(scene, make_target(scene), start_candidate(scene), sim::Rung::photons, 1);
  REQUIRE(judged.metrics.back().metric == Metric::intensity_rmse);
  const Figure& figure = judged.metrics.back().figure;
  CHECK(judged.objective.value == figure.value);
  CHECK(figure.noise > 0);
  REQUIRE(figure.half_interval);
  CHECK(std::abs(figure.value - figure.bias - reflectance * alone) < 2 * *figure.half_interval + 1e-4);
  CHECK(judged.far_photons == 80000);
}

TEST_CASE("without a table there is no intensity, and bad tables are refused", "[far_field]") {
  const TemporaryFolder folder;
  Scene scene = sphere(folder, level(alone, 50));
  scene.target.angles_rad.clear();
  CHECK_FALSE(far_field(scene));
  const Target target = make_target(scene);
  CHECK_THROWS_WITH(require_metric(scene, target), Catch::Contains("target.intensity_file"));
  scene.search.metric = Metric::rmse;
  for (const MetricFigure& each : judge(scene, target, start_candidate(scene), sim::Rung::photons, 1).metrics)
    CHECK(each.metric != Metric::intensity_rmse);
  CHECK_THROWS_WITH(sphere(folder, "0,1\n86,1\n"), Catch::Contains("angle 86"));
  CHECK_THROWS_WITH(sphere(folder, "10,1\n5,1\n"), Catch::Contains("wanted.csv:3"));
  CHECK_THROWS_WITH(sphere(folder, "0,1\n5,-1\n"), Catch::Contains("intensity -1 is out of range"));
  CHECK_THROWS_WITH(sphere(folder, "0,1\n"), Catch::Contains("no angle above 0"));
}
