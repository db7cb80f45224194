#include "base/intensity_table.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "base/errors.h"
#include "base/units.h"

using namespace catoptric;

namespace {

std::vector<double> even(double first, double last, int steps) {
  std::vector<double> angles;
  for (int i = 0; i <= steps; ++i) angles.push_back(first + (last - first) * i / steps);
  return angles;
}

IntensityTable sampled(const std::vector<double>& gamma, const std::vector<double>& c,
                       const std::function<double(double, double)>& intensity) {
  std::vector<double> values;
  for (const double plane : c)
    for (const double angle : gamma) values.push_back(intensity(angle * pi / 180, plane * pi / 180));
  return {LightQuantity::luminous, gamma, c, values};
}

/// Simpson's rule over what at() gives, piece by piece.
double flux_by_simpson(const IntensityTable& table) {
  double sum = 0;
  std::vector<double> c = table.c_deg();
  c.push_back(360);
  constexpr int steps = 64;
  const double h = pi / 180 / steps;
  for (std::size_t j = 0; j + 1 < c.size(); ++j)
    for (std::size_t i = 0; i + 1 < table.gamma_deg().size(); ++i) {
      const double begin = table.gamma_deg()[i], width = table.gamma_deg()[i + 1] - begin;
      for (int k = 0; k <= steps; ++k) {
        const double gamma = begin + width * k / steps;
        const double weight = k == 0 || k == steps ? 1 : k % 2 == 0 ? 2 : 4;
        // linear in C, so the middle is the mean
        sum += weight / 3 * h * width * table.at(std::min(gamma, 180.0), (c[j] + c[j + 1]) / 2) *
               std::sin(gamma * pi / 180) * (c[j + 1] - c[j]) * pi / 180;
      }
    }
  return sum;
}

}  // namespace

TEST_CASE("isotropic light has 4 pi times its intensity as flux, whatever the angles") {
  for (const int steps : {1, 2, 7, 180, 3600}) {
    const auto one = sampled(even(0, 180, steps), {0}, [](double, double) { return 10; });
    CHECK(one.flux() == Approx(40 * pi).epsilon(1e-14));
    CHECK(one.zonal_flux(0, 60) == Approx(10 * pi).epsilon(1e-13));  // 2 pi (1 - cos 60)
    const auto planes = sampled(even(0, 180, steps), {0, 10, 200}, [](double, double) { return 10; });
    CHECK(planes.flux() == Approx(40 * pi).epsilon(1e-14));
  }
}

TEST_CASE("a linear intensity has the flux of its integral in closed form") {
  // integral over the sphere of gamma: 2 pi [sin g - g cos g] from 0 to pi = 2 pi^2
  for (const int steps : {1, 3, 18'000}) {
    const auto table = sampled(even(0, 180, steps), {0}, [](double gamma, double) { return gamma; });
    CHECK(table.flux() == Approx(2 * pi * pi).epsilon(1e-13));
  }
}

TEST_CASE("powers of the cosine have their closed form to the error of interpolation") {
  for (const int power : {1, 2, 5, 20})
    for (const int steps : {90, 180}) {
      const auto table = sampled(even(0, 90, steps), {0}, [&](double gamma, double) {
        return 100 * std::pow(std::max(0.0, std::cos(gamma)), power);
      });
      const double exact = 100 * 2 * pi / (power + 1), h = pi / 2 / steps;
      // |I''| <= 100 (n + n(n-1)); a chord is off by h^2/8 of it, over 2 pi sr where sin integrates to 1
      const double bound = h * h / 8 * 100 * power * power * 2 * pi;
      CHECK(std::abs(table.flux() - exact) <= bound);
      CHECK(table.flux() != Approx(exact).epsilon(1e-9));  // the interpolant's, not the cosine's
    }
}

TEST_CASE("flux is that of what at gives, planes and angles uneven") {
  const auto table = sampled({0, 3, 50, 51, 90, 177, 180}, {0, 17, 90, 91, 300}, [](double gamma, double c) {
    return 3 + std::cos(gamma) + std::sin(gamma) * std::cos(c + 0.3);
  });
  CHECK(table.flux() == Approx(flux_by_simpson(table)).epsilon(1e-9));
}

TEST_CASE("zones add up to all and end at any angle") {
  const auto table =
      sampled({0, 10, 35, 90}, {0, 120, 240}, [](double gamma, double c) { return 2 + std::cos(c) + gamma; });
  CHECK(table.zonal_flux(0, 7.3) + table.zonal_flux(7.3, 48) + table.zonal_flux(48, 180) ==
        Approx(table.flux()).epsilon(1e-14));
  CHECK(table.zonal_flux(90, 180) == 0);
  CHECK(table.zonal_flux(20, 20) == 0);
}

TEST_CASE("between angles intensity is bilinear, over the turn's seam too, and dark beyond its range") {
  const IntensityTable table(LightQuantity::radiant, {0, 90}, {0, 90, 270}, {0, 10, 0, 20, 0, 40});
  CHECK(table.at(90, 0) == 10);
  CHECK(table.at(45, 0) == 5);
  CHECK(table.at(90, 45) == 15);
  CHECK(table.at(90, 315) == 25);
  CHECK(table.at(90, -45) == 25);
  CHECK(table.at(90, 720 + 90) == 20);
  CHECK(table.at(90, -1e-18) == 10);
  CHECK(table.at(90.0000001, 0) == 0);
  CHECK(table.at(180, 0) == 0);
  CHECK(table.maximum() == 40);
  const IntensityTable upward(LightQuantity::luminous, {90, 180}, {0}, {4, 8});
  CHECK(upward.at(89, 3) == 0);
  CHECK(upward.at(135, 3) == 6);
  CHECK(upward.at(180, 3) == 8);
}

TEST_CASE("an intensity table that breaks a rule is refused by the value that does") {
  const auto refused = [](std::vector<double> gamma, std::vector<double> c, std::vector<double> values,
                          const char* part) {
    CHECK_THROWS_WITH(IntensityTable(LightQuantity::luminous, gamma, c, values), Catch::Contains(part));
  };
  const double nan = std::nan("");
  refused({0, 90, 45}, {0}, {1, 1, 1}, "gamma angle 3 is 45 after 90");
  refused({0, 0, 90}, {0}, {1, 1, 1}, "none is there twice");
  refused({0, nan, 90}, {0}, {1, 1, 1}, "gamma angle 2 is not finite");
  refused({0, 60}, {0}, {1, 1}, "from 0 to 90, from 90 to 180 or from 0 to 180");
  refused({90}, {0}, {1}, "less than two");
  refused({0, 90}, {}, {}, "full turn");
  refused({0, 90}, {5, 90}, {1, 1, 1, 1}, "begin at 0");
  refused({0, 90}, {0, 360}, {1, 1, 1, 1}, "below 360");
  refused({0, 90}, {0}, {1}, "1 intensities for 1 planes of 2");
  refused({0, 90}, {0}, {1, -1}, "intensity 2 is -1 cd");
  refused({0, 90}, {0}, {nan, 1}, "intensity 1 is nan cd");
  refused({0, 90}, {0}, {HUGE_VAL, 1}, "intensity 1 is inf cd");
}
