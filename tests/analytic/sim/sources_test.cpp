#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "base/errors.h"
#include "base/random_stream.h"
#include "base/units.h"
#include "sim/clear_view.h"
#include "sim/disc_source.h"
#include "sim/frame.h"
#include "sim/projection_map.h"
#include "sim/tubes.h"
#include "sim/tubes_jacobian.h"
#include "support/analytic_reflectors.h"

/// Direct and reflected light of sources with an axis, against formulas and brute force.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double power = pi / 100;

/// A disc's light by a midpoint rule, with what stands in the way.
double brute_force(const Vector3& center, double radius, const Vector3& axis, const Vector3& point,
                   const Vector3& normal, Probe* mirror, int rings) {
  const Eigen::Matrix3d frame = frame_about(axis);
  const int turns = 4 * rings;
  double sum = 0;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < turns; ++j) {
      const double r = radius * (i + 0.5) / rings, a = 2 * pi * (j + 0.5) / turns;
      const Vector3 from = center + r * std::cos(a) * frame.col(0) + r * std::sin(a) * frame.col(1);
      const Vector3 way = from - point;
      const double here = way.dot(normal), there = -way.dot(frame.col(2));
      if (!(here > 0 && there > 0) || (mirror && mirror->blocks(from, point, 1e-7))) continue;
      sum += here * there / std::pow(way.squaredNorm(), 2) * r;
    }
  const double exitance = power / (pi * radius * radius);
  return sum * exitance / pi * (radius / rings) * (2 * pi / turns);
}

}  // namespace

TEST_CASE("a disc's direct light on its axis is M R^2 / (R^2 + h^2)") {
  for (const double radius : {1e-3, 1.0, 10.0, 500.0})
    for (const double height : {0.01, 3.0, 50.0, 1e5}) {
      const LambertianDisc disc({1, 2, 50}, radius, {0, 0, -1}, power);
      const double wanted =
          power / (pi * radius * radius) * (radius * radius / (radius * radius + height * height));
      CHECK(disc.unhindered_w_per_mm2({1, 2, 50 - height}, {0, 0, 1}) == Approx(wanted).epsilon(1e-12));
      CHECK(disc.unhindered_w_per_mm2({1, 2, 50 - height}, {0, 0, -1}) == 0);  // it looks away
      CHECK(disc.unhindered_w_per_mm2({1, 2, 50 + height}, {0, 0, -1}) == 0);  // the disc's dark side
    }
}

TEST_CASE(
    "a disc's direct light anywhere is what a sum over its parts gives, cut by the element's plane or not",
    "[long]") {
  int cut = 0, whole = 0;
  for (std::uint64_t i = 0; i < 120; ++i) {
    RandomStream stream(3, Purpose::test, i);
    const auto number = [&] { return 2 * stream.uniform() - 1; };
    const Vector3 axis = Vector3(number(), number(), number()).normalized();
    const Vector3 normal = Vector3(number(), number(), number()).normalized();
    const Vector3 center(number(), number(), number());
    const Vector3 point = center + 3 * Vector3(number(), number(), number()) + 0.3 * axis;
    if (std::abs((point - center).dot(axis)) < 0.2) continue;  // too near for the midpoint rule
    const LambertianDisc disc(center, 1, axis, power);
    const double wanted = brute_force(center, 1, axis, point, normal, nullptr, 400);
    const double middle = (center - point).dot(normal), swing = normal.cross(axis).norm();
    const bool parted = std::abs(middle) < swing;
    if (wanted > 0) ++(parted ? cut : whole);
    CAPTURE(i, parted);
    // the rule's own error at the edge of what it sees
    CHECK(disc.unhindered_w_per_mm2(point, normal) ==
          Approx(wanted).epsilon(1e-4).margin(parted ? 1e-5 * power : 0));
  }
  CHECK(cut > 8);
  CHECK(whole > 8);
}

TEST_CASE("a small disc is a point by Lambert's law, and a point's direct light follows its exponent") {
  const Vector3 axis = Vector3(0.2, -0.3, -1).normalized(), normal = Vector3(0.1, 0, 1).normalized();
  const LambertianDisc disc({1, 2, 50}, 1e-3, axis, power);
  const PointSource lambert({1, 2, 50}, power, 1, axis);
  for (const Vector3& point : {Vector3(0, 0, 0), Vector3(30, 10, -20), Vector3(-60, 5, 20)})
    CHECK(disc.unhindered_w_per_mm2(point, normal) ==
          Approx(lambert.unhindered_w_per_mm2(point, normal)).epsilon(1e-8));
  for (const double exponent : {0.5, 1.0, 3.0, 50.0}) {
    const PointSource source({0, 0, 40}, power, exponent, {0, 0, -2});
    const double cosine = 0.8, distance = 50;  // 30 aside, 40 below
    CHECK(source.unhindered_w_per_mm2({30, 0, 0}, {0, 0, 1}) ==
          Approx(power * (exponent + 1) / (2 * pi) * std::pow(cosine, exponent) * cosine /
                 (distance * distance))
              .epsilon(1e-13));
    CHECK(source.unhindered_w_per_mm2({30, 0, 80}, {0, 0, -1}) == 0);
    // all of the intensity together is the power
    double sum = 0;
    constexpr int steps = 200'000;
    for (int i = 0; i < steps; ++i) {
      const double c = 2 * (i + 0.5) / steps - 1;
      sum += 2 * pi * source.intensity_w_per_sr({std::sqrt(1 - c * c), 0, c}) * 2 / steps;
    }
    CHECK(sum == Approx(power).epsilon(1e-5));
  }
}

TEST_CASE("the mirror hides a part of a disc from an element, to a hundredth") {
  const auto mirror = test::paraboloid();  // rim of 100 mm at z = 50
  const auto probe = mirror.probe();
  const LambertianDisc disc({0, 0, 50}, 20, {0, 0.6, -0.8}, power);
  int parted = 0;
  for (int i = 0; i < 40; ++i) {
    const Vector3 point(4.0 * i, 110, 47 + 0.2 * i), normal = Vector3(0, -1, 0);
    const double open = disc.unhindered_w_per_mm2(point, normal);
    const double got = disc.direct_w_per_mm2(point, normal, *probe, 1e-7);
    const double wanted = brute_force({0, 0, 50}, 20, {0, 0.6, -0.8}, point, normal, probe.get(), 100);
    CHECK(got == Approx(wanted).margin(0.012 * open));
    parted += wanted > 0.02 * open && wanted < 0.98 * open;
  }
  CHECK(parted >= 3);
}

TEST_CASE("where the view of a whole disc is proven clear, no point of it is hidden") {
  const auto mirror = test::paraboloid();
  const auto samples = NearField::disc({0, 0, 0}, {0, 0, 1}, 60).samples(50);
  CHECK(is_view_clear(mirror.profile(), {0, 0, 50}, 10, samples));
  CHECK_FALSE(is_view_clear(mirror.profile(), {0, 0, 50}, 99, samples));
  const auto wide = NearField::disc({0, 0, 40}, {0, 0, 1}, 400).samples(50);
  CHECK_FALSE(is_view_clear(mirror.profile(), {0, 0, 60}, 10, wide));
}

TEST_CASE("tubes give a paraboloid's light of a point with an exponent, upright and upside down") {
  constexpr double a = 50;
  const std::vector<double> radii{0, 5, 20, 40, 60, 80, 99};
  for (const double up : {1.0, -1.0}) {
    const auto profile = Profile::bezier({{0, up * 100, 1}, {50, up * 100, 1}, {100, up * 50, 1}});
    for (const double exponent : {0.5, 1.0, 2.5, 50.0, 300.0}) {
      CAPTURE(up, exponent);
      const PointSource source({0, 0, up * 50}, power, exponent, {0, 0, up});
      const TubesField field = tubes_field(source, profile, {}, {0, up > 0}, radii, {});
      for (std::size_t i = 0; i < radii.size(); ++i) {
        const double t = radii[i] * radii[i] / (4 * a * a), cosine = (1 - t) / (1 + t);
        const double wanted =
            power * (exponent + 1) / (2 * pi) * std::pow(cosine, exponent) / (a * a * (1 + t) * (1 + t));
        CHECK(field.irradiance[i] == Approx(wanted).epsilon(1e-9).margin(1e-15 * power));
      }
      CHECK(field.landed_w == Approx(power).epsilon(1e-9));  // the mirror takes the whole half space
    }
  }
}

TEST_CASE("tubes' smoothed light of an exponent carries all the power") {
  const auto profile = Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}});
  for (const double exponent : {0.3, 1.0, 2.5, 50.0, 700.5}) {
    CAPTURE(exponent);
    const PointSource source({0, 0, 50}, power, exponent);
    TubesOptions options;
    options.kernel_radius_mm = 4;
    options.tolerance_w_per_mm2 = from_w_per_m2(1e-7);
    constexpr int steps = 2200;
    std::vector<double> radii;
    for (int i = 0; i < steps; ++i) radii.push_back(110.0 * (i + 0.5) / steps);
    const TubesField field = tubes_field(source, profile, {}, {0, true}, radii, options);
    CHECK(field.error_w_per_mm2 <= options.tolerance_w_per_mm2);
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += field.irradiance[i] * 2 * pi * radii[i] * 110.0 / steps;
    // The midpoint rule's first error, from the slope on the axis; what is left is the tolerance on the area.
    sum -= 2 * pi * field.irradiance[0] * std::pow(110.0 / steps, 2) / 24;
    CHECK(sum == Approx(power).epsilon(1e-6));
  }
}

TEST_CASE("derivatives of tubes hold for a point with an exponent") {
  const std::vector<double> radii{3, 20, 45, 70, 95};
  for (const double exponent : {0.5, 3.0}) {
    const PointSource source({0, 0, 50}, power, exponent);
    TubesOptions options;
    options.kernel_radius_mm = 5;
    options.tolerance_w_per_mm2 = from_w_per_m2(1e-9);
    const auto shape = [](double w1) { return Profile::bezier({{0, 100, 1}, {50, 100, w1}, {100, 50, 1}}); };
    const TubesJacobian got = tubes_jacobian(source, shape(1.3), {}, {0, true}, radii, options);
    const auto field = [&](double w1) {
      return tubes_field(source, shape(w1), {}, {0, true}, radii, options).irradiance;
    };
    const double step = 1e-3;
    const auto a = field(1.3 - step), b = field(1.3 + step), c = field(1.3 - 2 * step),
               d = field(1.3 + 2 * step);
    for (std::size_t i = 0; i < radii.size(); ++i) {
      const double wanted = (8 * (b[i] - a[i]) - (d[i] - c[i])) / (12 * step);
      CHECK(got.by_variable(static_cast<Eigen::Index>(i), 5) ==
            Approx(wanted).epsilon(1e-3).margin(1e-5 * power / 1e4));
    }
  }
}

TEST_CASE("a point with exponent 0 is the even point, bit by bit") {
  const auto profile = test::paraboloid().profile();
  const PointSource even({3, 4, 60}, power), zero({3, 4, 60}, power, 0, {1, 2, 3});
  const ProjectionMap map = even.directions_to(profile), other = zero.directions_to(profile);
  CHECK(even.power_into_w(map) == map.solid_angle_sr() / (4 * pi) * power);
  CHECK(zero.power_into_w(other) == even.power_into_w(map));
  CHECK(zero.tilt_rad() == 0);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    RandomStream stream(3, Purpose::test, i);
    const double first = stream.uniform(), second = stream.uniform();
    const Vector3 a = even.emit(map, {first, second, 0, 0}).direction,
                  b = zero.emit(other, {first, second, 0, 0}).direction;
    CHECK(std::memcmp(a.data(), b.data(), sizeof(double) * 3) == 0);
  }
  const Vector3 point(1, 2, 3), normal(0, 0, 1), way = Vector3(3, 4, 60) - point;
  CHECK(zero.unhindered_w_per_mm2(point, normal) ==
        power / (4 * pi) * (way.z() / way.norm()) / way.norm() / way.norm());
}

TEST_CASE("sources refuse what is none") {
  CHECK_THROWS_AS(PointSource({0, 0, 0}, 1, -1), InputError);
  CHECK_THROWS_AS(PointSource({0, 0, 0}, 1, 1001), InputError);
  CHECK_THROWS_AS(PointSource({0, 0, 0}, 1, NAN), InputError);
  CHECK_THROWS_AS(PointSource({0, 0, 0}, 1, 1, {0, 0, 0}), InputError);
  CHECK_THROWS_AS(LambertianDisc({0, 0, 0}, 0, {0, 0, 1}, 1), InputError);
  CHECK_THROWS_AS(LambertianDisc({0, 0, 0}, 1, {0, 0, NAN}, 1), InputError);
  CHECK_THROWS_AS(LambertianDisc({0, 0, 0}, 1, {0, 0, 1}, -1), InputError);
}
