#include "design/variables.h"

#include <catch2/catch.hpp>

using namespace catoptric;
using namespace catoptric::design;

TEST_CASE("names of components are read strictly") {
  CHECK(parse_component("w1", 3)->point == 1);
  CHECK(parse_component("r0", 3)->coordinate == 'r');
  CHECK(parse_component("z11", 12)->point == 11);
  for (const char* bad : {"", "w", "x1", "w3", "w-1", "w01", "w1 ", "W1", "r1.0", "w99999999999999999999"}) {
    INFO(bad);
    CHECK_FALSE(parse_component(bad, 3));
  }
}

TEST_CASE("a family moves what is named, in the scene's unit, and nothing else") {
  const Profile base = Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}});
  const ProfileFamily family(base, {"w1", "r2", "z2"}, LengthUnit::centimetre);
  const std::vector<double> values{1.6, 9, 4};
  const auto moved = family.at(values);
  REQUIRE(moved);
  CHECK(moved->points() == std::vector<ControlPoint>{{0, 100, 1}, {50, 100, 1.6}, {90, 40, 1}});
  CHECK(component_value(*moved, *parse_component("r2", 3), LengthUnit::centimetre) == 9);
  CHECK(component_value(*moved, *parse_component("w1", 3), LengthUnit::inch) == 1.6);
  const std::vector<double> crossing{1, -1, 5};
  CHECK_FALSE(family.at(crossing));
}
