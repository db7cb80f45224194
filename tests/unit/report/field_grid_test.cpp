#include "report/field_grid.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/errors.h"

using namespace catoptric;
using namespace catoptric::report;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// A sunflower spiral: even by area over a disc.
ScatteredField sunflower(int count, double radius, double (*f)(double, double)) {
  ScatteredField field;
  for (int i = 0; i < count; ++i) {
    const double r = radius * std::sqrt((i + 0.5) / count);
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    field.x.push_back(r * std::cos(angle));
    field.y.push_back(r * std::sin(angle));
    field.value.push_back(f(field.x.back(), field.y.back()));
  }
  return field;
}

}  // namespace

TEST_CASE("a constant field stays constant and fills its disc, no more") {
  const GridField grid = gridded(sunflower(500, 3, [](double, double) { return 2.5; }), 60, 3.0);
  const double cell = grid.x[1] - grid.x[0];
  for (std::size_t j = 0; j < grid.y.size(); ++j)
    for (std::size_t i = 0; i < grid.x.size(); ++i) {
      const double r = std::hypot(grid.x[i], grid.y[j]);
      if (r <= 3) {
        CHECK(grid.at(i, j) == Approx(2.5));
      } else if (r > 3 + 1.001 * cell) {
        CHECK(std::isnan(grid.at(i, j)));
      }
    }
}

TEST_CASE("gridding keeps within the samples and close to a smooth field") {
  const GridField grid = gridded(sunflower(4000, 1, [](double x, double y) { return x + 2 * y; }), 50, 1.0);
  const double distance = std::sqrt(std::numbers::pi / 4000);
  for (std::size_t j = 0; j < grid.y.size(); ++j)
    for (std::size_t i = 0; i < grid.x.size(); ++i)
      // every sample that counts lies within two sample distances, and the slope is sqrt(5)
      if (std::hypot(grid.x[i], grid.y[j]) <= 1)
        CHECK(std::abs(grid.at(i, j) - (grid.x[i] + 2 * grid.y[j])) <= 2 * distance * std::sqrt(5.0));
}

TEST_CASE("on a sample the sample's own value stands") {
  // four samples one apart: the grid of 2 x 2 cells has its centres on them
  const GridField grid = gridded({{0, 1, 0, 1}, {0, 0, 1, 1}, {1, 2, 3, 4}}, 2);
  REQUIRE(grid.x.size() == 2);
  // the outer half distance is 1/4: area 1, four samples, so centres are at 0.125 and 0.875, not on samples
  CHECK(grid.at(0, 0) < 1.2);
  CHECK(grid.at(1, 1) > 3.8);
  const GridField fine = gridded({{0, 1, 0, 1}, {0, 0, 1, 1}, {1, 2, 3, 4}}, 3);
  CHECK(fine.at(1, 1) == Approx(2.5));
}

TEST_CASE("few, coincident and broken samples do not break the grid") {
  CHECK(gridded({{1}, {2}, {3}}, 10).value.size() == 100);
  CHECK_NOTHROW(gridded({{1, 1}, {2, 2}, {3, 5}}, 10));
  CHECK_NOTHROW(gridded({{0, 1, 2}, {0, 0, 0}, {1, 2, 3}}, 10));
  const GridField grid = gridded({{0, 1, nan_value}, {0, 1, 0}, {1, 1, nan_value}}, 4);
  for (double value : grid.value) CHECK((std::isnan(value) || value == 1));
  CHECK_THROWS_AS(gridded({{}, {}, {}}, 10), InputError);
  CHECK_THROWS_AS(gridded({{nan_value}, {0}, {1}}, 10), InputError);
  CHECK_THROWS_AS(gridded({{1, 2}, {2}, {3}}, 10), InputError);
}

TEST_CASE("bilinear values are exact on a product surface and at the nodes") {
  GridField field{{0, 1, 4}, {-1, 2}, {}};
  const auto f = [](double x, double y) { return 1 + 2 * x - y + 3 * x * y; };
  for (double y : field.y)
    for (double x : field.x) field.value.push_back(f(x, y));
  for (double y : {-1.0, 0.5, 2.0})
    for (double x : {0.0, 0.25, 1.0, 3.0, 4.0}) CHECK(interpolated(field, x, y) == Approx(f(x, y)));
  CHECK(interpolated(field, 99, 99) == f(4, 2));
  CHECK(interpolated(field, -99, -99) == f(0, -1));
  const GridField fine = refined(field, 8);
  CHECK(fine.x.size() == 9);
  CHECK(fine.at(8, 8) == f(4, 2));
}

TEST_CASE("a hole empties what touches it, not the node beside it") {
  GridField field{{0, 1, 2}, {0, 1}, {5, std::numeric_limits<double>::infinity(), 7, 5, 6, 7}};
  CHECK(interpolated(field, 0, 0) == 5);
  CHECK(interpolated(field, 2, 0) == 7);
  CHECK(std::isnan(interpolated(field, 0.5, 0)));
  CHECK(std::isnan(interpolated(field, 1, 0)));
  CHECK(interpolated(field, 1, 1) == 6);
}

TEST_CASE("grids that are none are refused") {
  CHECK_THROWS_AS(require_sound(GridField{{0}, {0, 1}, {1, 2}}), InputError);
  CHECK_THROWS_AS(require_sound(GridField{{0, 1}, {0, 1}, {1, 2, 3}}), InputError);
  CHECK_THROWS_AS(require_sound(GridField{{0, 0}, {0, 1}, {1, 2, 3, 4}}), InputError);
  CHECK_THROWS_AS(require_sound(GridField{{0, nan_value}, {0, 1}, {1, 2, 3, 4}}), InputError);
  CHECK_NOTHROW(require_sound(GridField{{0, 1}, {0, 1}, {1, 2, 3, nan_value}}));
}
