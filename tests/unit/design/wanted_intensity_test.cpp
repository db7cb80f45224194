#include "design/wanted_intensity.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "design/far_field.h"
#include "design/metrics.h"
#include "design/scene.h"
#include "support/photometric_texts.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::design;
using namespace catoptric::test;

namespace {

Scene scene(const std::filesystem::path& file, const std::string& light, const std::string& more = "") {
  const std::string text = "[source]\nposition = [0, 0, 5]\n" + light +
                           "\n[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n[near_field]\n"
                           "center = [0, 0, -100]\nradius = 50\nsamples = 20\n[target]\nintensity_file = '" +
                           file.string() + "'\n" + more;
  return make_scene(Settings::parse(text, "s.toml", scene_keys()));
}

std::string all_notes(const Scene& spec) {
  std::string all;
  for (const std::string& note : spec.target.notes) all += note + "\n";
  return all;
}

const double degree = pi / 180;

}  // namespace

TEST_CASE("of a photometric file the mean over C is wanted, linear between its angles, up to 85 degrees") {
  const TemporaryFolder folder;
  write_whole(folder / "lamp.ies", sound_ies());  // C 0: 100 50 0, C 90: 200 60 10 at 0, 45, 90
  write_whole(folder / "lamp.ldt", sound_ldt());  // the same by Isym 4, cd/klm of 2 x 1000 lm
  const Scene ies = scene(folder / "lamp.ies", "flux = 1000");
  REQUIRE(ies.target.angles_rad.size() == 3);
  CHECK(ies.target.angles_rad[1] == Approx(45 * degree));
  CHECK(ies.target.angles_rad[2] == Approx(85 * degree));
  CHECK(ies.target.intensities_w_per_sr[0] == Approx(150));
  CHECK(ies.target.intensities_w_per_sr[1] == Approx(55));
  CHECK(ies.target.intensities_w_per_sr[2] == Approx(55 + (5 - 55) * 40.0 / 45));
  CHECK(far_field(ies) != nullptr);
  const Scene ldt = scene(folder / "lamp.ldt", "flux = 1000", "intensity_level = 0.5\n");
  CHECK(ldt.target.intensities_w_per_sr[0] == Approx(ies.target.intensities_w_per_sr[0]));
  CHECK_THAT(all_notes(ies), Catch::Contains("not alike in all C planes") && Catch::Contains("85 degrees"));
}

TEST_CASE("candela are no W/sr, but their shape may be wanted") {
  const TemporaryFolder folder;
  write_whole(folder / "lamp.ies", sound_ies());
  CHECK_THROWS_WITH(scene(folder / "lamp.ies", "power = 1"),
                    Catch::Contains("target.intensity_file") && Catch::Contains("cd in a scene of W"));
  Scene spec = scene(folder / "lamp.ies", "power = 1", "intensity_scale = \"free\"\n");
  const auto far = far_field(spec);
  std::vector<double> same = far->target.irradiance_w_per_mm2;
  for (double& each : same) each *= 1e-3;
  const auto value = [&](Metric metric, const std::vector<double>& field) {
    return *metric_value(metric, far->scene, field, far->target);
  };
  CHECK(value(Metric::relative_intensity_rmse, same) == Approx(0).margin(1e-12));
  CHECK(value(Metric::intensity_rmse, same) == Approx(0).margin(1e-9));
  CHECK(value(Metric::relative_intensity_rmse, std::vector<double>(same.size(), 1.0)) > 0.1);
  Target target;
  target.far = far;
  spec.search.metric = Metric::intensity_rmse;
  CHECK_THROWS_WITH(require_metric(spec, target), Catch::Contains("relative-intensity-rmse"));
  spec.search.metric = Metric::relative_intensity_rmse;
  CHECK_NOTHROW(require_metric(spec, target));
}

TEST_CASE("the relative error of an absolute intensity is over the table's root mean square") {
  const TemporaryFolder folder;
  write_whole(folder / "t.csv", "angle,intensity\n0,4\n60,4\n");
  const Scene spec = scene(folder / "t.csv", "power = 1");
  const auto far = far_field(spec);
  std::vector<double> field = far->target.irradiance_w_per_mm2;
  for (double& each : field) each *= 1.25;
  CHECK(*metric_value(Metric::relative_intensity_rmse, far->scene, field, far->target) == Approx(0.25));
  CHECK(*metric_value(Metric::intensity_rmse, far->scene, field, far->target) == Approx(1).epsilon(0.01));
  CHECK_FALSE(metric_value(Metric::rmse, far->scene, field, far->target));
  CHECK(scene(folder / "t.csv", "power = 1", "intensity_level = 3\n").target.intensities_w_per_sr[0] == 12);
}

TEST_CASE("intensities that do not fit are refused") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& name, const std::string& text, const std::string& more,
                           const std::string& part) {
    INFO(name << text << more);
    write_whole(folder / name, text);
    CHECK_THROWS_WITH(scene(folder / name, "flux = 1000", more), Catch::Contains(part));
  };
  refused("up.ies",
          small_ies("IESNA:LM-63-2002\n", "1 1000 1 2 1 1 2 0.1 0.2 0\n1 1 10", "90 180\n0\n100 50"), "",
          "begins at 90 degrees");
  refused("bad.ies", "IESNA:LM-63-2002\nTILT=NONE\n", "", "bad.ies");
  refused("lamp.ies", sound_ies(), "intensity_level = 2\nintensity_scale = \"free\"\n", "has no effect");
  refused("a.csv", "angle,intensity\n0,1\n86,1\n", "", "angle 86");
  const std::string text =
      "[source]\npower = 1\n[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n"
      "[near_field]\nradius = 5\n[target]\nintensity_scale = \"free\"\n";
  CHECK_THROWS_WITH(make_scene(Settings::parse(text, "s.toml", scene_keys())),
                    Catch::Contains("target.intensity_scale: stands alone"));
}

TEST_CASE("the mean over C is that of the interpolant, whatever the planes' widths") {
  // planes at 0 and 90 of a full turn: between 90 and 360 the table runs from 4 back to 1
  const IntensityTable uneven(LightQuantity::luminous, {0, 90}, {0, 90}, {1, 1, 4, 4});
  double sum = 0;
  constexpr int steps = 3600;
  for (int i = 0; i < steps; ++i) sum += uneven.at(45, (i + 0.5) * 360 / steps) / steps;
  CHECK(means_over_c(uneven)[0] == Approx(sum).epsilon(1e-9));
  CHECK(means_over_c(uneven)[0] == Approx(2.5));
  const IntensityTable planes(LightQuantity::luminous, {0, 90}, {0, 10, 180}, {1, 1, 4, 4, 2, 2});
  CHECK(means_over_c(planes)[1] == Approx((2.5 * 10 + 3 * 170 + 1.5 * 180) / 360));
}

TEST_CASE("how far a table is from alike all round: closed forms") {
  // From plane to plane 90 degrees apart 1 + a, 1 - a and back: a triangle's mean square is a^2 / 3.
  const double a = 0.3, off = a * a / 3;
  const IntensityTable four(LightQuantity::luminous, {0, 90}, {0, 90, 180, 270},
                            {1 + a, 1 + a, 1 - a, 1 - a, 1 + a, 1 + a, 1 - a, 1 - a});
  CHECK(c_asymmetry_rel(four, 0, 90) == Approx(std::sqrt(off / (1 + off))).epsilon(1e-9));
  CHECK(c_asymmetry_rel(four, 10, 50) == Approx(std::sqrt(off / (1 + off))).epsilon(1e-9));
  const IntensityTable alike(LightQuantity::luminous, {0, 90}, {0, 90}, {3, 1, 3, 1});
  CHECK(c_asymmetry_rel(alike, 0, 85) < 1e-12);
  CHECK(c_asymmetry_rel(IntensityTable(LightQuantity::luminous, {0, 90}, {0}, {3, 1}), 0, 85) == 0);
  // against a sum over directions
  const IntensityTable random = [] {
    for (std::uint64_t i = 0;; ++i) {
      IntensityTable table = random_table(i);
      if (table.c_deg().size() > 3 && table.gamma_deg().front() == 0) return table;
    }
  }();
  double all = 0, rest = 0;
  constexpr int rings = 600, turns = 720;
  for (int i = 0; i < rings; ++i) {
    const double gamma = 85 * (i + 0.5) / rings;
    std::vector<double> ring;
    double mean = 0;
    for (int j = 0; j < turns; ++j) {
      ring.push_back(random.at(gamma, (j + 0.5) * 360 / turns));
      mean += ring.back() / turns;
    }
    for (const double each : ring) {
      all += each * each * std::sin(gamma * degree);
      rest += (each - mean) * (each - mean) * std::sin(gamma * degree);
    }
  }
  CHECK(c_asymmetry_rel(random, 0, 85) == Approx(std::sqrt(rest / all)).epsilon(1e-3));
}
