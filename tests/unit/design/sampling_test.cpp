#include "design/sampling.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "design/target.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

Settings settings(const std::string& field, const std::string& more = "") {
  return Settings::parse(
      "unit = \"m\"\n[source]\nposition = [0, 0, 3]\npower = 1\n[reflector]\npoints = [[0, 3.1], [0.05, "
      "3.1], "
      "[0.1, 3.05]]\n[near_field]\n" +
          field + more,
      "s.toml", scene_keys());
}

Scene scene(const std::string& field, const std::string& more = "") {
  return make_scene(settings(field, more));
}

const std::string room = "shape = \"rectangle\"\nwidth = 6\nheight = 4\n";

}  // namespace

TEST_CASE("the grid of EN 12464-1 has the spacings of the standard's formula") {
  // the formula's round values, and what the standard's table rounds them to: d, p in m
  for (const auto& [d, p] : {std::pair{1.0, 0.2}, {10.0, 1.0}, {100.0, 5.0}, {0.1, 0.04}}) {
    INFO(d);
    CHECK(en12464_grid(1e3 * d, 1e3 * d).greatest_spacing_mm == Approx(1e3 * p));
  }
  CHECK(en12464_grid(5e3, 5e3).greatest_spacing_mm == Approx(0.6e3).epsilon(0.05));
  CHECK(en12464_grid(25e3, 25e3).greatest_spacing_mm == Approx(2e3).epsilon(0.1));
  CHECK(en12464_grid(900e3, 900e3).greatest_spacing_mm == 10e3);  // the formula alone: 23 m
}

TEST_CASE("the longer side decides, the shorter one where the other is twice as long or more") {
  const double p_of_10 = 1e3, p_of_5 = 200 * std::pow(5, std::log10(5.0));
  CHECK(en12464_grid(10e3, 5.01e3).greatest_spacing_mm == Approx(p_of_10));
  CHECK(en12464_grid(10e3, 5e3).greatest_spacing_mm == Approx(p_of_5));
  CHECK(en12464_grid(5e3, 10e3).greatest_spacing_mm == Approx(p_of_5));
  CHECK(en12464_grid(5.01e3, 10e3).greatest_spacing_mm == Approx(p_of_10));
}

TEST_CASE("cells are the fewest that are no longer than the spacing allowed") {
  const MeasuringGrid ten = en12464_grid(10e3, 7.2e3);  // p = 1 m
  CHECK(ten.columns == 10);  // a whole number of cells is not one more for rounding
  CHECK(ten.rows == 8);
  for (double width = 0.3e3; width < 60e3; width *= 1.37)
    for (double height = 0.3e3; height < 60e3; height *= 1.61) {
      INFO(width << " " << height);
      const MeasuringGrid grid = en12464_grid(width, height);
      const double p = grid.greatest_spacing_mm * (1 + 1e-9);
      CHECK(width / static_cast<double>(grid.columns) <= p);
      CHECK(height / static_cast<double>(grid.rows) <= p);
      if (grid.columns > 1) CHECK(width / static_cast<double>(grid.columns - 1) > p);
      if (grid.rows > 1) CHECK(height / static_cast<double>(grid.rows - 1) > p);
    }
  CHECK_THROWS_WITH(en12464_grid(1e8, 1e8), Catch::Contains("too large"));
}

TEST_CASE("a scene on the grid looks at its cells' centres, and its text reads back as the same") {
  const Scene spec = scene(room, "center = [1, 2, 0]\ngrid = \"en12464\"\n");
  const double p = 0.2 * std::pow(5, std::log10(6.0));  // 0.69 m
  const auto columns = static_cast<std::size_t>(std::ceil(6 / p)),
             rows = static_cast<std::size_t>(std::ceil(4 / p));
  CHECK(spec.samples == columns * rows);
  const Target target = make_target(spec);
  REQUIRE(target.samples.size() == columns * rows);
  const double dx = 6e3 / static_cast<double>(columns), dy = 4e3 / static_cast<double>(rows);
  CHECK((target.samples.front().point_mm - Vector3(1e3 - 3e3 + dx / 2, 2e3 - 2e3 + dy / 2, 0)).norm() < 1e-9);
  CHECK((target.samples[1].point_mm - target.samples[0].point_mm - Vector3(dx, 0, 0)).norm() < 1e-9);
  CHECK((target.samples.back().point_mm - Vector3(1e3 + 3e3 - dx / 2, 2e3 + 2e3 - dy / 2, 0)).norm() < 1e-9);
  CHECK(spacing(spec).first_mm == Approx(dx));
  CHECK(spacing(spec).second_mm == Approx(dy));
  const std::string text = scene_text(spec);
  const Scene again = written_scene(Settings::parse(text, "again.toml", scene_keys()));
  CHECK(scene_text(again) == text);
  CHECK(again.samples == spec.samples);
}

TEST_CASE("samples even by area stay as they were, and say how far apart they are") {
  const Scene rectangle = scene(room, "samples = 96\n");
  const Target target = make_target(rectangle);
  const auto before = rectangle.near_field.samples(96);
  REQUIRE(target.samples.size() == before.size());
  for (std::size_t i = 0; i < before.size(); ++i) CHECK(target.samples[i].point_mm == before[i].point_mm);
  CHECK(spacing(rectangle).first_mm == Approx(500));
  CHECK(spacing(rectangle).second_mm == Approx(500));
  const Scene disc = scene("radius = 2\nsamples = 100\n");
  CHECK(spacing(disc).first_mm == Approx(std::sqrt(pi * 4e6 / 100)));
}

TEST_CASE("the grid is refused where it does not fit") {
  const auto refused = [](const std::string& field, const std::string& more, const std::string& part) {
    INFO(field << more);
    CHECK_THROWS_WITH(scene(field, more), Catch::Contains(part));
  };
  refused("radius = 2\n", "grid = \"en12464\"\n", "near_field.grid: does not fit a disc");
  refused(room, "grid = \"en12464\"\nsamples = 512\n", "near_field.samples: stands beside a grid");
  refused(room, "grid = \"en12464\"\n[target]\nkind = \"csv\"\nfile = \"t.csv\"\n", "has no effect");
  CHECK(scene(room, "grid = \"en12464\"\nsamples = 54\n").samples == 54);
}
