#include "design/target.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "design/evaluator.h"
#include "design/metrics.h"
#include "design/radial_target.h"
#include "design/target_smoothing.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

const std::string data = CATOPTRIC_DATA;

Scene scene(const std::string& more) {
  const std::string text =
      "unit = \"cm\"\n[source]\nposition = [0, 0, 5]\npower = 0.0314\n[reflector]\npoints = [[0, 10], [5, "
      "10], [10, 5]]\n[near_field]\nradius = 5\n" +
      more;
  return make_scene(Settings::parse(text, "s.toml", scene_keys()));
}

void refused(const std::string& more, const std::string& part) {
  INFO(more);
  CHECK_THROWS_WITH(scene(more), Catch::Contains(part));
}

/// The kernel's mean about a point, by a grid in polar coordinates about it: nothing of rings.
double by_grid(const std::function<double(double)>& function, double at, double kernel_radius) {
  constexpr int steps = 1000;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double t = (i + 0.5) / steps, azimuth = pi * (j + 0.5) / steps;
      const double x = at + kernel_radius * t * std::cos(azimuth), y = kernel_radius * t * std::sin(azimuth);
      sum += 3 * (1 - t * t) * (1 - t * t) * 2 * t * function(std::hypot(x, y));
    }
  return sum / steps / steps;
}

}  // namespace

TEST_CASE("targets along the radius are what their keys say") {
  const auto at = [](const Scene& spec, double radius_cm) {
    return to_w_per_m2(radial_target(spec)->total_w_per_mm2(10 * radius_cm));
  };
  const Scene ring = scene(
      "[target]\nkind = \"ring\"\ninner_radius = 1\nouter_radius = 3\nirradiance = 2\nbackground = 0.5\n");
  CHECK(at(ring, 1) == 0.5);
  CHECK(at(ring, 1.01) == 2);
  CHECK(at(ring, 3) == 2);
  CHECK(at(ring, 3.01) == 0);
  CHECK(radial_target(ring)->jumps_mm == std::vector<double>{10, 30});
  CHECK(radial_target(ring)->reach_mm == 30);
  CHECK(radial_target(ring)->dark_beyond);
  const Scene gaussian = scene("[target]\nkind = \"gaussian\"\npeak = 3\nfwhm = 2\n");
  CHECK(at(gaussian, 1) == Approx(1.5));
  CHECK(radial_target(gaussian)->reach_mm == Approx(30 / std::sqrt(2 * std::log(2.0))));
  CHECK(at(gaussian, 3.01 / std::sqrt(2 * std::log(2.0))) == 0);
  const Scene zones = scene("[target]\nkind = \"zones\"\nradii = [1, 2]\nirradiances = [3, 1]\n");
  CHECK(at(zones, 0.5) == 3);
  CHECK(at(zones, 1.5) == 1);
  const catoptric::test::TemporaryFolder folder;
  std::ofstream(folder / "t.csv") << "radius (cm),irradiance,count\n1,2,1\n3,4,3\n";
  const Scene table = scene("[target]\nkind = \"radial\"\nfile = '" + (folder / "t.csv").string() +
                            "'\nweight_column = \"count\"\n");
  CHECK(at(table, 0.2) == 2);
  CHECK(at(table, 2) == Approx(3));
  CHECK(at(table, 3.01) == 0);
  const Target weighted = make_target(table);
  for (std::size_t i = 0; i < weighted.samples.size(); ++i) {
    const double radius_cm = weighted.samples[i].point_mm.head<2>().norm() / 10;
    CHECK(weighted.weights[i] == Approx(std::min(3.0, std::max(1.0, radius_cm))));
    CHECK(weighted.within_reach[i] == (radius_cm <= 3 ? 1 : 0));
  }
  CHECK_FALSE(radial_target(scene("")).has_value());
}

TEST_CASE("targets that contradict themselves are refused") {
  refused("[target]\nkind = \"uniform\"\nradius = 3\n", "target.irradiance: is missing");
  refused("[target]\nkind = \"uniform\"\nradius = 3\nirradiance = 1\npeak = 2\n", "does not belong");
  refused("[target]\nkind = \"ring\"\ninner_radius = 3\nouter_radius = 2\nirradiance = 1\n", "come after");
  refused("[target]\nkind = \"zones\"\nradii = [1, 2]\nirradiances = [1]\n", "1 for 2 radii");
  refused("[target]\nkind = \"uniform\"\nradius = 3\nirradiance = 1\nzone_weights = [1]\n",
          "1 weights for 1");
  refused("[target]\nkind = \"gaussian\"\npeak = 3\n", "one width");
  refused("[target]\nkind = \"gaussian\"\npeak = 3\nsigma = 1\nfwhm = 2\n", "one width");
  refused("normal = [0, 1, 1]\n[target]\nkind = \"uniform\"\nradius = 3\nirradiance = 1\n", "tilted");
  const catoptric::test::TemporaryFolder folder;
  std::ofstream(folder / "t.csv") << "radius,irradiance\n3,4\n1,2\n";
  refused("[target]\nkind = \"radial\"\nfile = '" + (folder / "t.csv").string() + "'\n", "out of order");
}

TEST_CASE("a disc under the kernel: closed form in its centre, a grid elsewhere, and all of its power") {
  const double radius = 3, h = 1;
  const auto disc = [&](double r) { return r <= radius ? 1.0 : 0.0; };
  const auto small = [&](double r) { return r <= 0.6 ? 1.0 : 0.0; };
  const auto seen = [&](const auto& function, double edge, double at) {
    return kernel_means(function, {edge}, std::vector<double>{at}, sim::Kernel::silverman, h)[0];
  };
  CHECK(seen(small, 0.6, 0) == Approx(1 - std::pow(1 - 0.36, 3)).epsilon(1e-9));
  CHECK(seen(disc, radius, 0.5) == Approx(1).epsilon(1e-9));
  CHECK(seen(disc, radius, 4.01) == 0);
  for (double at : {0.3, 0.9, 2.2, 2.9, 3.0, 3.5}) {
    INFO(at);
    CHECK(seen(disc, radius, at) == Approx(by_grid(disc, at, h)).margin(2e-4));
    CHECK(seen(small, 0.6, at) == Approx(by_grid(small, at, h)).margin(2e-4));
  }
  double power = 0;
  constexpr int steps = 2000;
  for (int i = 0; i < steps; ++i) {
    const double at = 4.0 * (i + 0.5) / steps;
    power += seen(disc, radius, at) * 2 * pi * at * 4.0 / steps;
  }
  CHECK(power == Approx(pi * radius * radius).epsilon(1e-5));
}

TEST_CASE("another kernel is stood for by the Silverman kernel of its second moment") {
  const auto square = [](double r) { return r * r; };
  const std::vector<double> centre{0.0};
  CHECK(kernel_means(square, {}, centre, sim::Kernel::silverman, 2)[0] == Approx(4 * 0.25));
  CHECK(kernel_means(square, {}, centre, sim::Kernel::cone, 2)[0] == Approx(4 * 0.3));
  CHECK(kernel_means(square, {}, centre, sim::Kernel::constant, 2)[0] == Approx(4 * 0.5));
}

TEST_CASE("the kernel's bias cancels: a mirror that makes the wanted light has no error, rim and all") {
  // the light of the paper's paraboloid as a table along the radius, its jump at 2 a within the field
  const catoptric::test::TemporaryFolder folder;
  std::ofstream table(folder / "t.csv");
  table.precision(17);
  table << "radius,irradiance\n";
  const double power = 0.031415926535897934;
  const auto row = [&](double cm, bool inside) {
    const double total = paraboloid_direct_w_per_mm2(power, 50, 10 * cm) +
                         (inside ? paraboloid_reflected_w_per_mm2(power, 50, 101, 10 * cm) : 0.0);
    table << cm << ',' << to_w_per_m2(total) << '\n';
  };
  for (int i = 0; i <= 1000; ++i) row(0.01 * i, true);
  for (int i = 0; i <= 1000; ++i) row(10 + 1e-9 + 0.01 * i, false);
  table.close();
  const std::vector<Override> change{{"near_field.radius", "15", "test"},
                                     {"target.kind", "\"radial\"", "test"},
                                     {"target.file", "'" + (folder / "t.csv").string() + "'", "test"},
                                     {"model.kernel_radius", "1.0", "test"}};
  const Scene spec = read_scene(data + "/paper/paraboloid.toml", change);
  const Target seen = make_target(spec), sharp = make_sharp_target(spec);
  const auto field = total_by_rung(spec, sim::Rung::tubes, spec.profile, seen.samples, 0);
  CHECK(objective(spec, field, seen) < 1e-4);
  CHECK(objective(spec, field, sharp) > 2e-2);  // without the kernel the rim alone makes this much
}
