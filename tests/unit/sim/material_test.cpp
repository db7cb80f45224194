#include "sim/material.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "sim/fresnel.h"
#include "sim/scatter.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const Vector3 up(0, 0, 1);

double degrees(double value) { return value * pi / 180; }

std::string what_of(const Material& material) {
  const auto defect = find_defect(material);
  return defect ? defect->what : "";
}

/// Numbers that are taken from a stream of a photon.
std::size_t numbers_taken(const Material& material, Roulette roulette) {
  std::size_t taken = 0;
  RandomStream stream(1, Purpose::test, 0), twin = stream;
  scatter(material, roulette, Vector3(0.6, 0, -0.8), up, stream);
  const double next = stream.uniform();
  while (twin.uniform() != next) ++taken;
  return taken;
}

}  // namespace

TEST_CASE("a table of reflectances is linear between its angles and level beyond") {
  const Material mirror = Material::with_table({degrees(10), degrees(50), degrees(80)}, {0.5, 0.8, 0.2});
  CHECK(mirror.reflectance == 0.8);
  const auto at = [&](double angle) { return mirror.reflectance_at(std::cos(degrees(angle))); };
  CHECK(at(0) == Approx(0.5));
  CHECK(at(10) == Approx(0.5));
  CHECK(at(30) == Approx(0.65));
  CHECK(at(50) == Approx(0.8));
  CHECK(at(65) == Approx(0.5));
  CHECK(at(80) == Approx(0.2));
  CHECK(at(90) == Approx(0.2));
  const Material level = Material::with_table({0.3}, {0.7});
  CHECK(level.reflectance_at(0.2) == 0.7);
}

TEST_CASE("a metal reflects by Fresnel") {
  const Material mirror = Material::metal(1.1, 6.6);
  CHECK(mirror.reflectance_at(0.4) == conductor_reflectance(0.4, 1.1, 6.6));
  CHECK(mirror.reflectance_at(0) == Approx(1));
  CHECK(surviving_share(mirror) == 1);
}

TEST_CASE("tables and metals that are none are refused") {
  CHECK_THROWS_AS(Material::with_table({0, 1}, {0.5}), InputError);
  CHECK_THROWS_AS(Material::with_table({}, {}), InputError);
  CHECK_THROWS_AS(Material::with_table({0, 0}, {0.5, 0.5}), InputError);
  CHECK_THROWS_AS(Material::with_table({0, 1.6}, {0.5, 0.5}), InputError);
  CHECK_THROWS_AS(Material::with_table({-0.1, 1}, {0.5, 0.5}), InputError);
  CHECK_THROWS_AS(Material::with_table({0, 1}, {0.5, 1.01}), InputError);
  CHECK_THROWS_AS(Material::with_table({0, 1}, {0.5, NAN}), InputError);
  CHECK_THROWS_AS(Material::with_table({NAN, 1}, {0.5, 0.5}), InputError);
  CHECK_THROWS_AS(Material::with_table({0, 1}, {0, 0}), InputError);
  CHECK_THROWS_AS(Material::metal(0, 1), InputError);
  CHECK_THROWS_AS(Material::metal(1, -1), InputError);
  CHECK_THROWS_AS(Material::metal(1, HUGE_VAL), InputError);
  CHECK_NOTHROW(Material::with_table({0, degrees(90)}, {0, 1}));
}

TEST_CASE("materials are the same where their numbers are") {
  CHECK(Material::metal(1.1, 6.6) == Material::metal(1.1, 6.6));
  CHECK_FALSE(Material::metal(1.1, 6.6) == Material::metal(1.1, 6.5));
  CHECK_FALSE(Material::metal(1.1, 6.6) == Material{1, 0});
  CHECK(Material::with_table({0, 1}, {0.5, 0.6}) == Material::with_table({0, 1}, {0.5, 0.6}));
  CHECK_FALSE(Material::with_table({0, 1}, {0.5, 0.6}) == Material::with_table({0, 1}, {0.5, 0.7}));
  CHECK_FALSE(Material{0.5, 0, 0.1} == Material{0.5, 0, 0.2});
  CHECK_FALSE(Material{0.5, 0, 0, 0.1} == Material{0.5, 0, 0, 0.2});
}

TEST_CASE("shares that make light from nothing are named") {
  CHECK(what_of({0.5, 0.2, 0.3, 0.1}).empty());
  CHECK(what_of({0.7, 0.2, 0.1}).empty());  // 1 and a rounding
  CHECK_THAT(what_of({0.5, 0.2, 0.31}), Catch::Contains("diffuse reflectance 0.31"));
  CHECK_THAT(what_of({0, 0, 1.1}), Catch::Contains("diffuse reflectance 1.1"));
  CHECK_THAT(what_of({0, 0, NAN}), Catch::Contains("diffuse"));
  CHECK_THAT(what_of({1, 0, 0, 1.5}), Catch::Contains("roughness 1.5"));
  CHECK_THAT(what_of({1, 0, 0, 1e-9}), Catch::Contains("roughness"));
  CHECK_THAT(what_of({1, 0, 0, NAN}), Catch::Contains("roughness"));
  CHECK(what_of({1, 0, 0, 1e-4}).empty());
  Material metal = Material::metal(1.1, 6.6);
  CHECK(what_of(metal).empty());
  metal.diffuse = 0.01;  // at grazing incidence all is mirrored already
  CHECK_THAT(what_of(metal), Catch::Contains("greatest"));
  Material table = Material::with_table({0, 1.5}, {0.4, 0.7});
  table.diffuse = 0.3;
  CHECK(what_of(table).empty());
  table.transmittance = 0.1;
  CHECK_THAT(what_of(table), Catch::Contains("more than 1"));
}

TEST_CASE("what is certain takes no random number") {
  using enum Roulette;
  CHECK(numbers_taken({1, 0}, all) == 0);
  CHECK(numbers_taken({0.7, 0}, all) == 1);
  CHECK(numbers_taken({0.7, 0}, survivors) == 0);
  CHECK(numbers_taken({0, 0.4}, survivors) == 0);
  CHECK(numbers_taken({0.7, 0.2}, survivors) == 1);
  CHECK(numbers_taken({0, 0}, survivors) == 0);
  CHECK(numbers_taken(Material::matt(1), all) == 2);
  CHECK(numbers_taken(Material::matt(0.4), survivors) == 2);
  CHECK(numbers_taken(Material::metal(1.1, 6.6), survivors) == 1);
  CHECK(numbers_taken({1, 0, 0, 0.2}, all) == 3);
}

TEST_CASE("light is scattered into the side it came from, whichever way the normal looks") {
  const Vector3 in = Vector3(0.5, -0.3, -0.8).normalized();
  for (const double side : {1.0, -1.0})
    for (const Material& material :
         {Material::matt(1), Material{1, 0}, Material{1, 0, 0, 0.5}, Material::metal(1.1, 6.6)})
      for (std::uint64_t i = 0; i < 200; ++i) {
        RandomStream stream(3, Purpose::test, i);
        const Scattered after = scatter(material, Roulette::all, in, Vector3(side * up), stream);
        CHECK(std::abs(after.direction.norm() - 1) < 1e-15);
        if (after.interaction == Interaction::reflected) CHECK(after.direction.z() > 0);
      }
  RandomStream stream(3, Purpose::test, 0);
  const Scattered through = scatter({0, 1}, Roulette::all, in, up, stream);
  CHECK(through.interaction == Interaction::transmitted);
  CHECK(through.direction == in);
}
