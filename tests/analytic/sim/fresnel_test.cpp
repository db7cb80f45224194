#include "sim/fresnel.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

double squared(double x) { return x * x; }
double radians(double degrees) { return degrees * pi / 180; }

/// Fresnel's sine and tangent formulas, which share no step with the program's; long double, so that their
/// own cancellation does not show.
double by_sines(double incidence_rad, double index_ratio) {
  const long double in = incidence_rad, out = std::asin(std::sin(in) / index_ratio);
  const long double across = std::sin(in - out) / std::sin(in + out),
                    along = std::tan(in - out) / std::tan(in + out);
  return static_cast<double>(0.5L * (across * across + along * along));
}

/// Born & Wolf's formulas in squares of the real and imaginary part of the index.
double metal_by_squares(double incidence_rad, double n_, double k_) {
  const long double n = n_, k = k_, c = std::cos(static_cast<long double>(incidence_rad)), s2 = 1 - c * c;
  const long double t = n * n - k * k - s2, sum = std::sqrt(t * t + 4 * n * n * k * k);
  const long double a = std::sqrt((sum + t) / 2);
  const long double across = (sum + c * c - 2 * a * c) / (sum + c * c + 2 * a * c);
  const long double along =
      across * (c * c * sum + s2 * s2 - 2 * a * c * s2) / (c * c * sum + s2 * s2 + 2 * a * c * s2);
  return static_cast<double>(0.5L * (across + along));
}

Vector3 towards(double incidence_rad, double azimuth_rad) {
  return {std::sin(incidence_rad) * std::cos(azimuth_rad), std::sin(incidence_rad) * std::sin(azimuth_rad),
          -std::cos(incidence_rad)};
}

}  // namespace

TEST_CASE("a boundary met head-on reflects ((n - 1) / (n + 1))^2") {
  for (const double n : {1e-6, 0.3, 1 / 1.5, 0.999999, 1.0, 1.000001, 1.33, 1.5168, 4.0, 1e6})
    CHECK(dielectric_reflectance(1, n) == Approx(squared((n - 1) / (n + 1))).epsilon(1e-14).margin(0));
}

TEST_CASE("a boundary reflects by the sine and tangent formulas at every angle") {
  for (const double n : {0.4, 0.7, 0.99, 1.01, 1.5, 2.4, 10.0})
    for (double degrees = 1; degrees < 89.95; degrees += 1.27) {
      const double angle = radians(degrees);
      if (std::sin(angle) > 0.999 * n) continue;  // beside the critical angle a rounding of the cosine shows
      CHECK(dielectric_reflectance(std::cos(angle), n) ==
            Approx(by_sines(angle, n)).epsilon(1e-11).margin(1e-16));
    }
}

TEST_CASE("at Brewster's angle one polarisation is missing from the reflection") {
  for (const double n : {0.5, 0.75, 1.2, 1.5, 3.0}) {
    const double cosine = 1 / std::hypot(1.0, n);  // tan = n, and r_s = (1 - n^2) / (1 + n^2)
    CHECK(dielectric_reflectance(cosine, n) ==
          Approx(0.5 * squared((1 - n * n) / (1 + n * n))).epsilon(1e-13));
  }
}

TEST_CASE("reflection is total beyond the critical angle and at grazing incidence") {
  const double n = 1 / 1.5, critical = std::sqrt(1 - n * n);
  CHECK(dielectric_reflectance(critical * (1 - 1e-12), n) == 1);
  CHECK(dielectric_reflectance(critical / 2, n) == 1);
  CHECK(dielectric_reflectance(0, n) == 1);
  const double beside = dielectric_reflectance(critical * (1 + 1e-12), n);
  CHECK(beside < 1);
  CHECK(beside > 0.99999);
  for (const double index : {1.0001, 1.5, 100.0}) {
    CHECK(dielectric_reflectance(0, index) == 1);
    CHECK(dielectric_reflectance(1e-12, index) > 1 - 1e-9);
    CHECK(conductor_reflectance(0, index, 3) == Approx(1).epsilon(1e-15));
  }
  // To first order in the cosine: 1 - R = 2 c (1 + n^2) / sqrt(n^2 - 1).
  const double c = 1e-7;
  CHECK((1 - dielectric_reflectance(c, 1.5)) == Approx(2 * c * 3.25 / std::sqrt(1.25)).epsilon(1e-5));
}

TEST_CASE("light that goes the other way is reflected alike") {
  for (const double n : {1.001, 1.33, 1.9, 5.0})
    for (double degrees = 0; degrees < 89.9; degrees += 3.7) {
      const double sine = std::sin(radians(degrees)), beyond = std::sqrt(1 - squared(sine / n));
      CHECK(dielectric_reflectance(std::cos(radians(degrees)), n) ==
            Approx(dielectric_reflectance(beyond, 1 / n)).epsilon(1e-9));
    }
}

TEST_CASE("indices at their ends neither overflow nor cancel") {
  CHECK(dielectric_reflectance(0.3, 1) == 0);
  CHECK(dielectric_reflectance(0, 1) == 0);
  CHECK(dielectric_reflectance(1e-300, 1) == 0);
  CHECK(dielectric_reflectance(0.6, 1 + 1e-12) ==  // (n^2 - 1)^2 (1 + (c^2 - s^2)^2) / (32 c^4)
        Approx(squared(2.000177801164e-12) * (1 + squared(0.36 - 0.64)) / (32 * std::pow(0.6, 4)))
            .epsilon(1e-10));
  for (const double n : {1e-300, 1e-200, 1e200, 1e308}) {
    CHECK(dielectric_reflectance(1, n) == Approx(1));
    CHECK(dielectric_reflectance(0.5, n) == Approx(1));
    CHECK(conductor_reflectance(0.5, n < 1 ? n : 1, 1e200) == Approx(1));
    CHECK(conductor_reflectance(0.5, n, 1e-200) == Approx(1));
  }
  CHECK(conductor_reflectance(1e-9, 1, 1e-300) < 1e-200);
}

TEST_CASE("metals reflect head-on as Born and Wolf's table 14.1 has it") {
  struct Metal {
    const char* name;
    double index, extinction, reflectance;
  };
  for (const Metal& metal : {Metal{"silver", 0.20, 3.44, 0.94}, Metal{"gold", 0.47, 2.83, 0.82},
                             Metal{"aluminium", 1.44, 5.23, 0.83}, Metal{"copper", 0.62, 2.57, 0.73},
                             Metal{"iron", 1.51, 1.63, 0.33}}) {
    INFO(metal.name);
    CHECK(conductor_reflectance(1, metal.index, metal.extinction) ==
          Approx(metal.reflectance).margin(0.0051).epsilon(0));
  }
}

TEST_CASE("metals reflect by the formulas in squares at every angle") {
  for (const auto& [n, k] : {std::pair{1.1, 6.6}, {0.05, 4.0}, {1.44, 5.23}, {2.0, 1e-3}, {0.5, 1e-4}})
    for (double degrees = 0; degrees < 89.95; degrees += 1.31)
      CHECK(conductor_reflectance(std::cos(radians(degrees)), n, k) ==
            Approx(metal_by_squares(radians(degrees), n, k)).epsilon(1e-12));
}

TEST_CASE("a metal without extinction is a clear medium") {
  for (const double n : {0.6, 1.0, 1.5})
    for (const double cosine : {0.05, 0.1, 0.75, 0.9, 1.0}) {
      CHECK(conductor_reflectance(cosine, n, 0) == dielectric_reflectance(cosine, n));
      CHECK(conductor_reflectance(cosine, n, 1e-14) ==
            Approx(dielectric_reflectance(cosine, n)).margin(1e-6));
    }
}

TEST_CASE("refraction obeys Snell in the plane of incidence, whichever way the normal looks") {
  for (const double n : {0.5, 0.8, 1.0, 1.5, 2.4})
    for (double degrees = 0; degrees < 89.99; degrees += 2.3)
      for (const double side : {1.0, -1.0}) {
        const double sine = std::sin(radians(degrees)) / n;
        const Vector3 in = towards(radians(degrees), 0.7), normal(0, 0, side);
        const auto out = refract(in, normal, n);
        REQUIRE(out.has_value() == (sine < 1));
        if (!out) continue;
        CHECK(std::abs(out->norm() - 1) < 1e-15);
        CHECK(std::hypot(out->x(), out->y()) == Approx(sine).margin(1e-15));
        CHECK(out->z() < 0);
        CHECK(std::abs(out->dot(Vector3(-std::sin(0.7), std::cos(0.7), 0))) < 1e-15);
        // Back the same way: the reciprocal ratio undoes it.
        const auto back = refract(-*out, normal, 1 / n);
        REQUIRE(back);
        CHECK((*back + in).norm() < 1e-14 / std::max(1e-3, std::cos(radians(degrees))));
      }
}

TEST_CASE("refraction at the ends: alike media, huge and tiny ratios") {
  const Vector3 grazing = towards(radians(89.9999), 0.3);
  const auto same = refract(grazing, {0, 0, 1}, 1);
  REQUIRE(same);
  CHECK((*same - grazing).norm() < 1e-15);
  const auto into_dense = refract(grazing, {0, 0, 1}, 1e200);
  REQUIRE(into_dense);
  CHECK((*into_dense - Vector3(0, 0, -1)).norm() < 1e-15);
  const auto head_on = refract({0, 0, -1}, {0, 0, 1}, 1e-200);
  REQUIRE(head_on);
  CHECK(*head_on == Vector3(0, 0, -1));
  // Just within the critical angle of a tiny ratio: sines of 1e-9 count.
  const auto just_out = refract(towards(0.6e-9, 0), {0, 0, -1}, 1e-9);
  REQUIRE(just_out);
  CHECK(just_out->x() == Approx(0.6).epsilon(1e-6));
  CHECK_FALSE(refract(towards(1.1e-9, 0), {0, 0, 1}, 1e-9));
}
