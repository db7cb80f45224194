#include "design/metrics.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "design/search.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

/// A near field of 10 mm x 10 mm and a source of 1 mW: with four samples each stands for 25 mm^2.
Scene scene(const std::string& metric = "rmse", const std::string& target = "") {
  const std::string text =
      "[source]\nposition = [0, 0, 5]\npower = 0.001\n[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n"
      "[near_field]\nshape = \"rectangle\"\nwidth = 10\nheight = 10\n[search]\nmetric = \"" +
      metric + "\"\n[target]\nkind = \"uniform\"\nradius = 5\nirradiance = 1\n" + target;
  return make_scene(Settings::parse(text, "s.toml", scene_keys()));
}

/// Wanted 2, 2, 1 and 0 uW/mm^2; the last sample is out of reach, the third within it but not lit.
Target target(std::vector<double> weights = {}) {
  Target result{{}, {2e-6, 2e-6, 1e-6, 0}};
  result.samples.resize(4);
  result.weights = std::move(weights);
  result.within_reach = {1, 1, 1, 0};
  result.lit = {1, 1, 0, 0};
  return result;
}

const std::vector<double> field{3e-6, 1e-6, 1e-6, 2e-6};

}  // namespace

TEST_CASE("metrics of four samples, by hand") {
  const Scene spec = scene();
  const auto value = [&](Metric metric) { return *metric_value(metric, spec, field, target()); };
  CHECK(value(Metric::rmse) == Approx(std::sqrt((1 + 1 + 0 + 4) / 4.0)));  // W/m^2
  CHECK(value(Metric::relative_rmse) == Approx(std::sqrt(6.0 / 9)));
  CHECK(value(Metric::uniformity) == Approx(1 / 2.0));
  CHECK(value(Metric::diversity) == Approx(1 / 3.0));
  CHECK(value(Metric::enclosed_flux) == Approx((3 + 1 + 1) * 1e-6 * 25 / 1e-3));
  CHECK(value(Metric::efficiency) == Approx((3 + 1) * 1e-6 * 25 / 1e-3));
}

TEST_CASE("weights count in errors and means, and a sample of weight 0 is not there") {
  const Scene spec = scene();
  const auto value = [&](Metric metric, std::vector<double> weights) {
    return *metric_value(metric, spec, field, target(std::move(weights)));
  };
  CHECK(value(Metric::rmse, {1, 1, 1, 0}) == Approx(std::sqrt(2.0 / 3)));
  CHECK(value(Metric::relative_rmse, {3, 0, 5, 0}) == Approx(std::sqrt(3.0 / (3 * 4 + 5 * 1))));
  CHECK(value(Metric::uniformity, {1, 3, 1, 1}) == Approx(1 / 1.5));
  CHECK(value(Metric::uniformity, {1, 0, 1, 1}) == Approx(1));
  CHECK(value(Metric::diversity, {1, 3, 1, 1}) == Approx(1 / 3.0));
  CHECK(value(Metric::diversity, {1, 0, 1, 1}) == Approx(1));
  CHECK(value(Metric::rmse, {2, 2, 2, 2}) == Approx(value(Metric::rmse, {})));
  CHECK(value(Metric::efficiency, {0, 1, 1, 1}) == Approx(value(Metric::efficiency, {})));  // flux is flux
}

TEST_CASE("with a free scale the level that fits best is compared") {
  const Scene spec = scene("relative-rmse", "scale = \"free\"\n");
  std::vector<double> doubled(target().irradiance_w_per_mm2);
  for (double& each : doubled) each *= 7;
  CHECK(objective(spec, doubled, target()) == Approx(0).margin(1e-12));
  // level (3*2 + 1*2 + 1*1) / 9 = 1, and the field's own mean square is 15 / 4
  CHECK(objective(spec, field, target()) == Approx(std::sqrt(6.0 / 15)));
  CHECK(objective(spec, std::vector<double>(4, 0.0), target()) == 1);
  CHECK_THROWS_WITH(require_metric(scene("rmse", "scale = \"free\"\n"), target()),
                    Catch::Contains("free scale"));
}

TEST_CASE("where more is better a search makes 1 less it small") {
  CHECK(objective(scene("uniformity"), field, target()) == Approx(0.5));
  CHECK(objective(scene("diversity"), field, target()) == Approx(2 / 3.0));
  CHECK(objective(scene("efficiency"), field, target()) == Approx(0.9));
  CHECK(objective(scene("enclosed-flux"), field, target()) == Approx(0.875));
  CHECK(objective(scene("rmse"), field, target()) == Approx(std::sqrt(1.5)));
  CHECK(objective_name(Metric::uniformity) == "1 - uniformity");
}

TEST_CASE("a metric that says nothing about the target is refused before the search") {
  Target dark = target();
  dark.irradiance_w_per_mm2.assign(4, 0.0);
  dark.lit.assign(4, 0);
  CHECK_THROWS_WITH(require_metric(scene("relative-rmse"), dark), Catch::Contains("dark"));
  CHECK_THROWS_WITH(require_metric(scene("uniformity"), dark), Catch::Contains("dark"));
  CHECK_THROWS_WITH(require_metric(scene("diversity"), dark), Catch::Contains("dark"));
  CHECK_NOTHROW(require_metric(scene("rmse"), dark));
  CHECK_FALSE(metric_value(Metric::efficiency, scene(), field, dark).has_value());
}

TEST_CASE("zone weights reach the samples") {
  const Scene spec = scene("rmse", "zone_weights = [4, 0.5]\n");
  const Target made = make_target(spec);
  for (std::size_t i = 0; i < made.samples.size(); ++i)
    CHECK(made.weights[i] == (made.samples[i].point_mm.head<2>().norm() <= 5 ? 4.0 : 0.5));
}

TEST_CASE("flux is a share of the power that the design has, where the power is a variable") {
  const std::string text =
      "unit = \"cm\"\n[source]\nposition = [0, 0, 5]\npower = 0.03\n[reflector]\npoints = [[0, 10], [5, 10], "
      "[10, 5]]\n[near_field]\nradius = 5\n[search]\nmetric = \"enclosed-flux\"\n[target]\nkind = "
      "\"uniform\"\n"
      "radius = 4\nirradiance = 1\n[variables.source.power]\nstep = 0.01\nlower = 0.01\nupper = 1\n";
  const Scene spec = make_scene(Settings::parse(text, "s.toml", scene_keys()));
  const Target wanted = make_target(spec);
  const SceneFamily family(spec.with(spec.profile), {"source.power"}, spec.unit);
  const double once = value_at(spec, sim::Rung::tubes, wanted, family, std::vector<double>{0.03});
  const double double_power = value_at(spec, sim::Rung::tubes, wanted, family, std::vector<double>{0.06});
  CHECK(once > 0.1);
  // Ray tubes are asked for 2.5e-7 of all light, of the power as written.
  CHECK(double_power == Approx(once).epsilon(1e-6));
}

TEST_CASE(
    "evenness among the metrics is the near field's, free of blur, though errors compare through the "
    "kernel") {
  const Scene scene =
      read_scene(CATOPTRIC_DATA "/examples/uniform_disc.toml", {{"model.rung", "\"photons\"", "test"},
                                                                {"model.photons", "16384", "test"},
                                                                {"model.replicates", "4", "test"}});
  const SimulationResult result = run_simulation(scene, {});
  REQUIRE(result.target.through_kernel);
  const Judgement& judgement = result.mirror.judgement;
  for (const auto& [metric, figure] : judgement.metrics) {
    if (metric != Metric::uniformity && metric != Metric::diversity) continue;
    const Figure& field =
        metric == Metric::uniformity ? judgement.field.uniformity : judgement.field.diversity;
    CHECK(figure.value == Approx(field.value).epsilon(1e-12));
    CHECK(figure.bias == Approx(field.bias).epsilon(1e-9).margin(1e-12));
    CHECK(*figure.half_interval == Approx(*field.half_interval).epsilon(0.05));
  }
}
