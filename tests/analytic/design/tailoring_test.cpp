#include "design/tailoring.h"

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/random_stream.h"
#include "base/units.h"
#include "design/direction_residuals.h"
#include "design/profile_fit.h"
#include "support/paper_tailoring.h"

using namespace catoptric;
using namespace catoptric::design;
using namespace catoptric::test;

namespace {

constexpr double a = paper_focus_mm;

std::vector<double> angles(double last, std::size_t count) {
  std::vector<double> list;
  for (std::size_t i = 1; i <= count; ++i)
    list.push_back(last * static_cast<double>(i) / static_cast<double>(count));
  return list;
}

}  // namespace

TEST_CASE("the equation of the mirror gives the paraboloid for the paraboloid's light") {
  const FluxMap map = paper_map();
  const auto curve =
      tailored_curve(map, paper_layout, RayMap::diverging, a, angles(map.last_angle_rad(), 25));
  const auto* points = std::get_if<std::vector<CurvePoint>>(&curve);
  REQUIRE(points);
  REQUIRE(points->size() == 26);
  for (const CurvePoint& point : *points) {
    CHECK(point.z_mm == Approx(2 * a - point.r_mm * point.r_mm / (4 * a)).margin(1e-8));
    CHECK(point.slope_z == Approx(-point.r_mm / (2 * a) * point.slope_r).margin(1e-6));
  }
}

TEST_CASE("the equation of the mirror holds upside down and for light that crosses the axis") {
  const FluxMap map = paper_map();
  const auto up = tailored_curve(map, paper_layout, RayMap::crossing, 0.7 * a, angles(1.2, 10));
  const auto down = tailored_curve(map, {-a, 0, -1}, RayMap::crossing, 0.7 * a, angles(1.2, 10));
  const auto &above = std::get<0>(up), &below = std::get<0>(down);
  for (std::size_t i = 0; i < above.size(); ++i) {
    CHECK(below[i].r_mm == Approx(above[i].r_mm).epsilon(1e-12));
    CHECK(below[i].z_mm == Approx(-above[i].z_mm).epsilon(1e-12));
    // What is reflected lands on the other side of the axis, where the balance puts it.
    const double length = std::hypot(above[i].slope_r, above[i].slope_z);
    const double nr = -above[i].slope_z / length, nz = above[i].slope_r / length;
    const double distance = std::hypot(above[i].r_mm, above[i].z_mm - a);
    const double dr = above[i].r_mm / distance, dz = (above[i].z_mm - a) / distance;
    const double out_r = dr - 2 * (dr * nr + dz * nz) * nr, out_z = dz - 2 * (dr * nr + dz * nz) * nz;
    const double landing = above[i].r_mm - above[i].z_mm * out_r / out_z;
    CHECK(-landing == Approx(map.at(above[i].angle_rad).radius_mm).margin(1e-7));
  }
}

TEST_CASE("a mirror that would be seen edge-on is refused in words") {
  // All light on a spot behind the source, as seen from the mirror's apex: no mirror turns the rays so far.
  const FluxMap map(polar_flux(1, 0, true), 1, {[](double) { return 1e-6; }, {}, 500});
  const auto curve = tailored_curve(map, {0, 40, 1}, RayMap::diverging, 30, angles(map.last_angle_rad(), 40));
  CHECK(std::holds_alternative<std::string>(curve));
}

TEST_CASE("a fitted spline follows the curve, begins smooth on the axis and ends where the curve ends") {
  const FluxMap map = paper_map();
  const auto curve =
      std::get<0>(tailored_curve(map, paper_layout, RayMap::diverging, a, angles(map.last_angle_rad(), 200)));
  const std::vector<double> knots = knots_with_breaks(3, 10, {0.4});
  CHECK(std::count(knots.begin(), knots.end(), 0.4) == 2);
  CHECK(knots.size() == 14);
  const auto control = fit_control_points(curve, 3, knots);
  CHECK(control[0].r_mm == 0);
  CHECK(control[1].z_mm == control[0].z_mm);
  const Profile profile(3, knots, control);
  for (const CurvePoint& point : curve) {
    const MeridianPoint at = profile.at(point.angle_rad / curve.back().angle_rad);
    CHECK(at.z_mm == Approx(2 * a - at.r_mm * at.r_mm / (4 * a)).margin(0.02));
  }
  CHECK(control.back().r_mm == Approx(curve.back().r_mm).epsilon(1e-5));
}

TEST_CASE("direction residuals vanish for the right mirror, and their derivatives are exact") {
  const FluxMap map = paper_map();
  const DirectionResiduals rays(map, paper_layout, RayMap::diverging, 2, Profile::uniform_knots(2, 3), 40);
  std::vector<double> miss(rays.size());
  rays.evaluate(std::vector<ControlPoint>{{0, 2 * a, 1}, {a, 2 * a, 1}, {2 * a, a, 1}}, miss, nullptr);
  for (const double each : miss) CHECK(std::abs(each) < 1e-9);

  const std::vector<ControlPoint> other{{0, 101, 1.1}, {47, 97, 1.7}, {85, 52, 0.9}};
  Eigen::MatrixXd jacobian;
  rays.evaluate(other, miss, &jacobian);
  for (int component = 0; component < 9; ++component) {
    const auto shifted = [&](double by) {
      std::vector<ControlPoint> points = other;
      ControlPoint& point = points[static_cast<std::size_t>(component / 3)];
      (component % 3 == 0 ? point.r_mm : component % 3 == 1 ? point.z_mm : point.weight) += by;
      std::vector<double> values(rays.size());
      rays.evaluate(points, values, nullptr);
      return values;
    };
    constexpr double step = 1e-5;
    const auto plus = shifted(step), minus = shifted(-step);
    for (std::size_t i = 0; i < miss.size(); ++i)
      CHECK(jacobian(static_cast<Eigen::Index>(i), component) ==
            Approx((plus[i] - minus[i]) / (2 * step)).margin(1e-9));
  }
}

TEST_CASE("the paper's starts, and random ones, all reach the paraboloid", "[long]") {
  const FluxMap map = paper_map();
  RandomStream random(7, Purpose::test, 0);
  std::vector<std::pair<double, double>> starts{{1.6, 90}, {1.8, 70}, {std::sqrt(0.5), 50}};
  for (int i = 0; i < 1000; ++i) {
    const double w1 = 0.05 + 19.95 * random.uniform();
    starts.emplace_back(w1, 10 + 290 * random.uniform());
  }
  int most_starts = 0;
  for (const auto& [w1, r2_mm] : starts) {
    INFO(w1 << " " << r2_mm);
    const Tailored tailored = tailor(map, paper_layout, RayMap::diverging, paper_variables(w1, r2_mm));
    CHECK(std::exp(tailored.values[0]) == Approx(1).epsilon(1e-6));
    CHECK(tailored.values[1] == Approx(2 * a).epsilon(1e-6));
    most_starts = std::max(most_starts, tailored.starts);
  }
  CHECK(most_starts <= 4);
}

TEST_CASE("tailoring never ends worse than it began, whatever it cannot reach") {
  const FluxMap map = paper_map();
  // The rim is pinned far from where the light ends: no weight can mend that.
  ProfileVariables family = paper_variables(1.3, 40);
  family.variables[1].lower = family.variables[1].upper = family.variables[1].start;
  const Tailored tailored = tailor(map, paper_layout, RayMap::diverging, family);
  CHECK(tailored.values[1] == 40);
  CHECK(tailored.miss_rad > 0.01);
  CHECK(tailored.starts > 1);
  const Tailored again = tailor(map, paper_layout, RayMap::diverging, family);
  CHECK(again.values == tailored.values);
}

TEST_CASE("light that begins away from the axis makes a mirror with a cone's tip") {
  // Between two radii, dark within: the ray along the axis lands on the inner one.
  constexpr double inner = 30, outer = 60, power = 1;
  const double even = 0.25 * power / (pi * (outer * outer - inner * inner));
  const FluxMap map(polar_flux(power, 0, true), 1,
                    {[=](double radius) { return radius < inner ? 0.0 : even; }, {inner}, outer});
  CHECK(map.break_angles_rad().empty());
  const AxialLayout layout{100, 0, 1};
  const auto curve =
      std::get<0>(tailored_curve(map, layout, RayMap::diverging, 20, angles(map.last_angle_rad(), 40)));
  CHECK(!begins_smooth(curve));
  // The normal at the tip halves the angle between the axis and the way to the inner radius.
  const double to_landing = std::atan2(inner, 120);
  CHECK(curve.front().slope_z / curve.front().slope_r == Approx(std::tan(0.5 * to_landing)));
  const std::vector<double> knots = knots_with_breaks(3, 10, map.break_angles_rad());
  const auto control = fit_control_points(curve, 3, knots);
  CHECK((control[1].z_mm - control[0].z_mm) / control[1].r_mm ==
        Approx(std::tan(0.5 * to_landing)).epsilon(1e-3));
}
