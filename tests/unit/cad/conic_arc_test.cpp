#include "cad/detail/conic_arc.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/errors.h"
#include "base/units.h"

using namespace catoptric;
using cad::detail::conic_arc;
using cad::detail::ConicArc;

namespace {

/// Points of all Bezier pieces, in order.
std::vector<Vector2> points_on(const ConicArc& arc) {
  std::vector<Vector2> points;
  for (std::size_t first = 0; first + 2 < arc.points.size(); first += 2)
    for (int i = 0; i <= 50; ++i) {
      const double s = i / 50.0;
      const std::array<double, 3> b{(1 - s) * (1 - s) * arc.weights[first],
                                    2 * s * (1 - s) * arc.weights[first + 1], s * s * arc.weights[first + 2]};
      points.push_back(
          (b[0] * arc.points[first] + b[1] * arc.points[first + 1] + b[2] * arc.points[first + 2]) /
          (b[0] + b[1] + b[2]));
    }
  return points;
}

double value(const std::array<double, 6>& c, const Vector2& p) {
  return c[0] * p.x() * p.x() + c[1] * p.x() * p.y() + c[2] * p.y() * p.y() + c[3] * p.x() + c[4] * p.y() +
         c[5];
}

double length(const std::vector<Vector2>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

constexpr std::array<double, 6> unit_circle{1, 0, 1, 0, 0, -1};

}  // namespace

TEST_CASE("An arc of the unit circle goes counterclockwise and has its angle as length") {
  for (const double from : {0.0, 1.0, 4.0})
    for (const double angle : {0.01, 1.0, 1.6, 3.0, 3.2, 5.0, 6.28}) {
      const ConicArc arc = conic_arc(unit_circle, {std::cos(from), std::sin(from)},
                                     {std::cos(from + angle), std::sin(from + angle)});
      CAPTURE(from, angle);
      const auto points = points_on(arc);
      for (const Vector2& p : points) CHECK(std::abs(p.norm() - 1) < 1e-15 * 4);
      CHECK(length(points) == Approx(angle).epsilon(1e-3));  // chords of 1/50 of a piece
      CHECK((points[1] - points[0]).dot(Vector2(-std::sin(from), std::cos(from))) > 0);
      for (const double weight : arc.weights) CHECK(weight >= std::sqrt(0.5) - 1e-9);
    }
  CHECK(length(points_on(conic_arc(unit_circle, {1, 0}, {1, 0}))) == Approx(2 * pi).epsilon(1e-3));
}

TEST_CASE("Turned and shifted conics: the equation holds along the arc, from start to end") {
  // x^2 + x y + 2 y^2 - 3 x + y - 4 = 0, any factor; the ends by solving for y at x = 0 and 1.
  for (const double factor : {1.0, -7.0, 1e-6}) {
    std::array<double, 6> c{1, 1, 2, -3, 1, -4};
    for (double& each : c) each *= factor;
    const Vector2 start(1, (-2 + std::sqrt(4 + 48.)) / 4), end(0, (-1 - std::sqrt(33.)) / 4);
    const ConicArc arc = conic_arc(c, start, end);
    CHECK(arc.kind == "ellipse");
    CHECK(arc.points.front() == start);
    CHECK(arc.points.back() == end);
    for (const Vector2& p : points_on(arc)) CHECK(std::abs(value(c, p) / factor) < 1e-13);
  }
  // (x + y)^2 - x = 0, a parabola whose axis runs along (1, -1).
  const std::array<double, 6> parabola{1, 2, 1, -1, 0, 0};
  const ConicArc arc = conic_arc(parabola, {0, 0}, {4, -2});
  CHECK(arc.kind == "parabola");
  CHECK(arc.weights == std::vector<double>{1, 1, 1});
  for (const Vector2& p : points_on(arc)) CHECK(std::abs(value(parabola, p)) < 1e-14);
  // x y = 1.
  const std::array<double, 6> hyperbola{0, 1, 0, 0, 0, -1};
  const ConicArc branch = conic_arc(hyperbola, {0.25, 4}, {4, 0.25});
  CHECK(branch.kind == "hyperbola");
  for (const Vector2& p : points_on(branch)) CHECK(std::abs(value(hyperbola, p)) < 1e-14);
}

TEST_CASE("An arc hardly longer than what counts as a full turn is one piece") {
  for (const double angle : {1.2e-6, 1.6e-6, 1e-4}) {
    const Vector2 end(std::cos(angle), std::sin(angle));
    const ConicArc arc = conic_arc(unit_circle, {1, 0}, end);
    CHECK(arc.points.size() == 3);
    CHECK(arc.points.back() == end);
    // by the arc's own points, whose coordinates are roundings of 1
    CHECK(length(points_on(arc)) == Approx(angle).margin(1e-14));
  }
}

TEST_CASE("What is no arc of a conic is refused") {
  const double none = std::nan("");
  CHECK_THROWS_AS(conic_arc(unit_circle, {1, 0}, {0, 1.001}), CadError);            // end off the conic
  CHECK_THROWS_AS(conic_arc({0, 1, 0, 0, 0, -1}, {0.5, 2}, {-0.5, -2}), CadError);  // two branches
  CHECK_THROWS_AS(conic_arc({0, 0, 0, 1, 1, -1}, {1, 0}, {0, 1}), CadError);        // a line
  CHECK_THROWS_AS(conic_arc({1, 0, 1, 0, 0, 1}, {1, 0}, {0, 1}), CadError);         // no real points
  CHECK_THROWS_AS(conic_arc({1, 0, -1, 0, 0, 0}, {1, 1}, {2, 2}), CadError);        // a pair of lines
  CHECK_THROWS_AS(conic_arc({1, 0, 0, 0, 1, 0}, {1, -1}, {1, -1}), CadError);       // no length
  CHECK_THROWS_AS(conic_arc({none, 0, 1, 0, 0, -1}, {1, 0}, {0, 1}), CadError);
  CHECK_THROWS_AS(conic_arc(unit_circle, {none, 0}, {0, 1}), CadError);
  // coefficients whose products leave the range of numbers
  CHECK_THROWS_AS(conic_arc({-1.7e-93, 1.8e-152, -1.7e-93, 7.4e-320, 0, 0}, {3.3e-28, 0}, {0, 0}), CadError);
  CHECK_THROWS_AS(conic_arc({1.7e-76, 9.4e-149, 6.5e-85, 3.4e78, 9.4e-61, 0}, {0, 0}, {0, -4.1e304}),
                  CadError);
  CHECK_THROWS_AS(conic_arc({-7.6e116, 6.7e151, 2.3e-152, -2.3e-206, 1.8e-322, 0}, {1.7e-77, 6e-317}, {0, 0}),
                  CadError);
  CHECK_THROWS_AS(conic_arc({3.5e97, 1.5e-47, 7.8e99, 7.1e-15, 8.6e159, -1.1e-95}, {5.7e223, 0}, {0, 0}),
                  CadError);
}
