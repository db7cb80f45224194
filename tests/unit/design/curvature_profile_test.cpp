#include "design/curvature_profile.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace catoptric;
using namespace catoptric::design;

namespace {

constexpr double radius_mm = 80, apex_mm = 100;

std::vector<std::string> names(const CurvatureProfile& family) {
  std::vector<std::string> list;
  for (const auto& variable : family.variables()) list.push_back(variable.name);
  return list;
}

std::vector<double> starts(const CurvatureProfile& family) {
  std::vector<double> list;
  for (const auto& variable : family.variables()) list.push_back(variable.start);
  return list;
}

/// A sixth of a circle from its apex on the axis downwards, as the conic that it is.
Profile circle_arc() {
  const double half = pi / 6, r = radius_mm;
  return Profile::bezier({{0, apex_mm, 1},
                          {r * std::tan(half), apex_mm, std::cos(half)},
                          {r * std::sin(2 * half), apex_mm - r * (1 - std::cos(2 * half)), 1}});
}

/// z = apex - r^2 / (4 focal), to r = 2 focal: the paper's paraboloid.
constexpr double focal_mm = 50;
const Profile parabola = Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}});

double parabola_curvature(double r_mm) {
  return -1 / (2 * focal_mm) / std::pow(1 + std::pow(r_mm / (2 * focal_mm), 2), 1.5);
}

/// r where the parabola has come this far from its vertex, by bisection of its length in closed form.
double parabola_radius(double length_mm) {
  double low = 0, high = length_mm;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high), x = middle / (2 * focal_mm);
    (focal_mm * (x * std::hypot(1.0, x) + std::asinh(x)) < length_mm ? low : high) = middle;
  }
  return low;
}

/// Greatest difference of a family's first curvatures from the parabola's own.
double curvature_error(int stations) {
  CurvatureProfileOptions options;
  options.stations = stations;
  const std::vector<double> x = starts(CurvatureProfile(parabola, options));
  double worst = 0;
  for (int i = 0; i < stations; ++i) {
    const double length_mm = x.back() * i / (stations - 1);
    const double off = x[1 + static_cast<std::size_t>(i)] - parabola_curvature(parabola_radius(length_mm));
    worst = std::max(worst, std::abs(off));
  }
  return worst;
}

/// Greatest distance of a profile from the circle through the apex with this radius.
double distance_from_circle(const Profile& profile, double circle_mm) {
  double worst = 0;
  for (int i = 0; i <= 1000; ++i) {
    const MeridianPoint p = profile.at(i / 1000.0);
    worst = std::max(worst, std::abs(std::hypot(p.r_mm, p.z_mm - (apex_mm - circle_mm)) - circle_mm));
  }
  return worst;
}

}  // namespace

TEST_CASE("a circle has one curvature, and all circles through its apex are reached", "[curvature]") {
  CurvatureProfileOptions options;
  options.unit = LengthUnit::centimetre;
  const CurvatureProfile family(circle_arc(), options);
  std::vector<double> x = starts(family);
  REQUIRE(names(family) == std::vector<std::string>{"z0", "kappa0", "kappa1", "kappa2", "kappa3", "kappa4",
                                                    "kappa5", "kappa6", "kappa7", "length"});
  CHECK(x.front() == Approx(10).epsilon(1e-14));
  for (std::size_t i = 1; i < 9; ++i) CHECK(x[i] == Approx(-10 / radius_mm).epsilon(1e-5));
  CHECK(x.back() == Approx(radius_mm / 10 * pi / 3).epsilon(1e-9));
  CHECK(family.start_error_mm() < 1e-3);

  // another circle: its curvature in 1/cm, its length in cm, its rim by hand
  constexpr double other_mm = 120, turn = 0.9;
  for (std::size_t i = 1; i < 9; ++i) x[i] = -10 / other_mm;
  x.back() = other_mm / 10 * turn;
  const auto profile = family.at(x);
  REQUIRE(profile);
  const MeridianPoint rim = profile->at(1);
  CHECK(rim.r_mm == Approx(other_mm * std::sin(turn)).epsilon(1e-12));
  CHECK(rim.z_mm == Approx(apex_mm - other_mm * (1 - std::cos(turn))).epsilon(1e-12));
  CHECK(std::atan2(rim.dz, rim.dr) == Approx(-turn).epsilon(1e-12));
  CHECK(std::abs(profile->at(0).dz) < 1e-12);  // smooth vertex
  const double off = distance_from_circle(*profile, other_mm);
  CHECK(off < 1e-5);
  CHECK(off <= 1.1 * family.fit_error_mm(x));                 // at other points than those it was taken at
  CHECK(distance_from_circle(*profile, other_mm + 1) > 0.1);  // the check can tell circles apart
}

TEST_CASE("a parabola's curvatures come nearer to its own as the square of their distance", "[curvature]") {
  const double coarse = curvature_error(5), fine = curvature_error(9), finest = curvature_error(17);
  CHECK(coarse < 0.1 / (2 * focal_mm));
  CHECK(coarse / fine > 3);
  CHECK(fine / finest > 3);
  CurvatureProfileOptions few, many;
  few.stations = 5;
  many.stations = 17;
  CHECK(CurvatureProfile(parabola, many).start_error_mm() <
        CurvatureProfile(parabola, few).start_error_mm() / 16);
}

TEST_CASE("a curvature leaves alone what lies before its stretch, and bends what lies behind",
          "[curvature]") {
  const CurvatureProfile family(circle_arc(), {});
  std::vector<double> x = starts(family);
  const auto before = family.at(x);
  x[6] *= 1.5;  // kappa5 of 0 ... 7: felt from station 4 on
  const auto after = family.at(x);
  REQUIRE(before);
  REQUIRE(after);
  const double fit_mm = family.fit_error_mm(x) + family.fit_error_mm(starts(family));
  REQUIRE(fit_mm < 0.01);
  for (int i = 0; i <= 40; ++i) {
    const double share = 4.0 / 7 * i / 40;
    const MeridianPoint p = before->at(share), q = after->at(share);
    CHECK(std::hypot(p.r_mm - q.r_mm, p.z_mm - q.z_mm) <= 1.1 * fit_mm);
  }
  const MeridianPoint p = before->at(1), q = after->at(1);
  CHECK(std::hypot(p.r_mm - q.r_mm, p.z_mm - q.z_mm) > 1);
  // the slope behind has turned by half the curvature's change over its two stretches
  const double turned = std::atan2(q.dz, q.dr) - std::atan2(p.dz, p.dr);
  CHECK(turned == Approx(-0.5 * (pi / 3) / 7).epsilon(1e-4));
}

TEST_CASE("the fit error grows with what a spline cannot follow, and is infinite for no generatrix",
          "[curvature]") {
  const CurvatureProfile family(circle_arc(), {});
  std::vector<double> x = starts(family);
  const double plain = family.fit_error_mm(x);
  for (std::size_t i = 1; i < 9; ++i) x[i] *= i % 2 == 0 ? 2 : 0.1;
  CHECK(family.fit_error_mm(x) > 5 * plain);
  CHECK(family.fit_error_mm(x) < 0.1);
  for (std::size_t i = 1; i < 9; ++i) x[i] = -0.05;  // more than half a turn of a circle of 20 mm
  CHECK_FALSE(family.at(x));
  CHECK(std::isinf(family.fit_error_mm(x)));
}

TEST_CASE("a vertex beside the axis or not smooth has an angle, a held one no height", "[curvature]") {
  CurvatureProfileOptions options;
  options.stations = 3;
  const auto names_of = [&](std::vector<ControlPoint> points) {
    return names(CurvatureProfile(Profile::bezier(std::move(points)), options));
  };
  const std::vector<std::string> all{"z0", "angle0", "kappa0", "kappa1", "kappa2", "length"};
  CHECK(names_of({{10, 100, 1}, {50, 100, 1}, {100, 50, 1}}) == all);
  CHECK(names_of({{0, 100, 1}, {50, 90, 1}, {100, 50, 1}}) == all);
  options.hold_vertex = true;
  CHECK(names_of({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}) ==
        std::vector<std::string>{"kappa0", "kappa1", "kappa2", "length"});
  const CurvatureProfile cone(Profile::bezier({{0, 100, 1}, {100, 50, 1}}), {});
  CHECK(starts(cone)[1] == Approx(std::atan2(-50, 100)).epsilon(1e-12));
  for (std::size_t i = 2; i < 10; ++i) CHECK(std::abs(starts(cone)[i]) < 1e-12);
}

TEST_CASE("stations and degrees that make no curve are refused", "[curvature]") {
  for (const auto& [stations, degree] : {std::pair{1, 3}, {65, 3}, {8, 2}, {8, 10}}) {
    CurvatureProfileOptions options;
    options.stations = stations;
    options.degree = degree;
    CHECK_THROWS_AS(CurvatureProfile(parabola, options), InputError);
  }
}
