#include "design/flux_map.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"

using namespace catoptric;
using namespace catoptric::design;

TEST_CASE("flux balance of the paraboloid's light puts each ray where the paraboloid does") {
  const double power_w = 2, a = 50;
  const WantedLight wanted{[=](double p) {
                             const double widening = 1 + p * p / (4 * a * a);
                             return power_w / (4 * pi * a * a * widening * widening);
                           },
                           {},
                           2 * a};
  const FluxMap map(polar_flux(power_w, 0, true), 1, wanted);
  CHECK(map.wanted_w() == Approx(0.5 * power_w).epsilon(1e-12));
  CHECK(map.last_angle_rad() == Approx(0.5 * pi).epsilon(1e-9));
  for (int i = 1; i < 100; ++i) {
    const double angle = 0.5 * pi * i / 100;
    CHECK(map.at(angle).radius_mm == Approx(2 * a * std::tan(0.5 * angle)).epsilon(1e-9));
    CHECK(map.at(angle).per_angle_mm == Approx(a / std::pow(std::cos(0.5 * angle), 2)).epsilon(1e-6));
  }
}

TEST_CASE(
    "an even disc is filled by the square root of the flux, whatever the source and the mirror's loss") {
  const double level = 0.01, reach = 30;
  const double exponent = GENERATE(0.0, 0.5, 1.0, 30.0);
  const double reflectance = GENERATE(1.0, 0.7);
  const PolarFlux source = polar_flux(100, exponent, true);
  const FluxMap map(source, reflectance, {[=](double) { return level; }, {}, reach});
  const double last = map.last_angle_rad();
  REQUIRE(last < pi);
  CHECK(reflectance * source.within_w(last) == Approx(level * pi * reach * reach).epsilon(1e-9));
  for (int i = 1; i < 20; ++i) {
    const double angle = last * i / 20;
    CHECK(map.at(angle).radius_mm ==
          Approx(std::sqrt(reflectance * source.within_w(angle) / (pi * level))).epsilon(1e-9));
  }
  CHECK(map.at(1.01 * last).radius_mm == Approx(reach));
  CHECK(map.at(1.01 * last).per_angle_mm == 0);
}

TEST_CASE("the derivative of the landing radius is that of the radius, across jumps and dark zones too") {
  const auto steps = [](double p) { return p < 10 ? 1.0 : p < 20 ? 0.0 : p < 25 ? 0.2 : 3.0; };
  const WantedLight wanted{steps, {10, 20, 25}, 40};
  const FluxMap map(polar_flux(4e4, 0, true), 0.9, wanted);
  const auto breaks = map.break_angles_rad();
  REQUIRE(breaks.size() == 3);
  // No light goes to the dark zone: the radius leaps over it.
  CHECK(map.at(breaks[0] * (1 - 1e-9)).radius_mm == Approx(10).epsilon(1e-6));
  CHECK(map.at(breaks[1] * (1 + 1e-9)).radius_mm == Approx(20).epsilon(1e-6));
  for (int i = 1; i < 200; ++i) {
    const double angle = map.last_angle_rad() * (i + 0.37) / 201, step = 1e-6;
    bool near_break = false;
    for (const double each : breaks) near_break |= std::abs(angle - each) < 2 * step;
    if (near_break) continue;
    const double slope = (map.at(angle + step).radius_mm - map.at(angle - step).radius_mm) / (2 * step);
    CHECK(map.at(angle).per_angle_mm == Approx(slope).epsilon(1e-5).margin(1e-6));
  }
}

TEST_CASE("a source that sends its light away from the mirror has none to place") {
  const PolarFlux away = polar_flux(10, 1, false);
  CHECK(away.within_w(0.5 * pi) == 0);
  CHECK(away.within_w(pi) == Approx(10));
  const FluxMap map(away, 1, {[](double) { return 1e-3; }, {}, 10});
  CHECK(map.last_angle_rad() > 0.5 * pi);
}

TEST_CASE("too much wanted light ends at the whole sphere") {
  const FluxMap map(polar_flux(1, 0, true), 1, {[](double) { return 1.0; }, {}, 10});
  CHECK(map.last_angle_rad() == Approx(pi));
  CHECK(map.wanted_w() > map.available_w(pi));
}
