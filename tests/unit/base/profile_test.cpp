#include "base/profile.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "base/profile_hull.h"
#include "base/units.h"

using namespace catoptric;

namespace {

Profile parabola() { return Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}); }
Profile quarter_circle() { return Profile::bezier({{0, 10, 1}, {5, 10, std::sqrt(0.5)}, {5, 5, 1}}); }

/// Value by the Cox-de Boor recursion: slow, and nothing in common with blossoms.
double basis(const std::vector<double>& knots, std::size_t i, int degree, double u) {
  if (degree == 0) return u >= knots[i] && u < knots[i + 1] ? 1.0 : 0.0;
  const auto p = static_cast<std::size_t>(degree);
  double value = 0;
  if (knots[i + p] > knots[i])
    value += (u - knots[i]) / (knots[i + p] - knots[i]) * basis(knots, i, degree - 1, u);
  if (knots[i + p + 1] > knots[i + 1])
    value += (knots[i + p + 1] - u) / (knots[i + p + 1] - knots[i + 1]) * basis(knots, i + 1, degree - 1, u);
  return value;
}

}  // namespace

TEST_CASE("a parabola is met exactly, with its derivatives") {
  const Profile profile = parabola();
  for (double u : {0.0, 0.1, 0.5, 0.77, 1.0}) {
    const MeridianPoint p = profile.at(u);
    CHECK(p.r_mm == Approx(100 * u).margin(1e-13));
    CHECK(p.z_mm == Approx(100 - p.r_mm * p.r_mm / 200).epsilon(1e-15));
    CHECK(p.dr == Approx(100));
    CHECK(p.dz == Approx(-100 * u).margin(1e-12));
    CHECK(p.ddr == Approx(0).margin(1e-12));
    CHECK(p.ddz == Approx(-100));
  }
  CHECK_FALSE(profile.is_rational());
}

TEST_CASE("a quarter circle stays on its circle, its area half a sphere, its length a quarter turn") {
  const Profile profile = quarter_circle();
  for (double u = 0; u <= 1; u += 0.05) {
    const MeridianPoint p = profile.at(u);
    CHECK(std::hypot(p.r_mm, p.z_mm - 5) == Approx(5).epsilon(1e-15));
    CHECK(p.r_mm * p.dr + (p.z_mm - 5) * p.dz == Approx(0).margin(1e-12));  // tangent across the radius
  }
  CHECK(profile.area_mm2() == Approx(2 * pi * 25).epsilon(1e-9));
  CHECK(profile.length_mm() == Approx(pi / 2 * 5).epsilon(1e-9));
  CHECK(profile.r_max_mm() == Approx(5).epsilon(1e-14));
}

TEST_CASE("spans agree with Cox-de Boor for every degree, multiple knots and unclamped ends") {
  for (int degree = 1; degree <= 9; ++degree) {
    for (const bool clamped : {true, false}) {
      const std::size_t count = static_cast<std::size_t>(degree) + 5;
      std::vector<double> knots = Profile::uniform_knots(degree, count);
      if (!clamped)
        for (std::size_t i = 0; i < knots.size(); ++i) knots[i] = std::pow(static_cast<double>(i), 1.1);
      else if (degree > 1)
        knots[static_cast<std::size_t>(degree) + 2] =
            knots[static_cast<std::size_t>(degree) + 1];  // double knot
      std::vector<ControlPoint> points;
      for (std::size_t i = 0; i < count; ++i) {
        const double x = static_cast<double>(i);
        points.push_back({1 + 10 * x, 50 - x * x + 3 * std::sin(5 * x), 1 + 0.5 * std::cos(3 * x)});
      }
      const Profile profile(degree, knots, points);
      const double first = profile.first_parameter(), last = profile.last_parameter();
      CHECK(first == knots[static_cast<std::size_t>(degree)]);
      CHECK(last == knots[count]);
      for (double share : {0.0, 0.013, 0.31, 0.5, 0.74, 0.999}) {
        const double u = first + share * (last - first);
        double rw = 0, zw = 0, w = 0;
        for (std::size_t i = 0; i < count; ++i) {
          const double n = basis(knots, i, degree, u) * points[i].weight;
          rw += n * points[i].r_mm;
          zw += n * points[i].z_mm;
          w += n;
        }
        const MeridianPoint p = profile.at(u);
        INFO("degree " << degree << " clamped " << clamped << " u " << u);
        CHECK(p.r_mm == Approx(rw / w).epsilon(1e-12));
        CHECK(p.z_mm == Approx(zw / w).epsilon(1e-12));
      }
      for (std::size_t i = 1; i < profile.spans().size(); ++i)
        CHECK(profile.spans()[i].rw.front() == profile.spans()[i - 1].rw.back());
    }
  }
}

TEST_CASE("derivatives agree with differences on a rational curve") {
  const Profile profile(3, Profile::uniform_knots(3, 6),
                        {{0, 100, 1}, {20, 100, 2}, {40, 95, 0.5}, {60, 80, 1}, {80, 60, 3}, {90, 20, 1}});
  const double h = 1e-5;
  for (double u : {0.1, 0.2, 0.5, 0.6, 0.9}) {
    const MeridianPoint p = profile.at(u), low = profile.at(u - h), high = profile.at(u + h);
    CHECK(p.dr == Approx((high.r_mm - low.r_mm) / (2 * h)).epsilon(1e-7));
    CHECK(p.dz == Approx((high.z_mm - low.z_mm) / (2 * h)).epsilon(1e-7));
    CHECK(p.ddr == Approx((high.dr - low.dr) / (2 * h)).epsilon(1e-6));
    CHECK(p.ddz == Approx((high.dz - low.dz) / (2 * h)).epsilon(1e-6));
  }
}

TEST_CASE("bounds come from the curve, not from its poles") {
  const Profile profile = Profile::bezier({{0, 0, 1}, {100, 0, 1}, {0, 50, 1}});
  CHECK(profile.r_max_mm() == Approx(50).epsilon(1e-12));  // 2 u (1 - u) 100 at u = 1/2
  for (const HullBox& box : hull_boxes(profile, 6)) {
    const MeridianPoint p = profile.at(0.5 * (box.first + box.last));
    CHECK(p.r_mm >= box.r_min_mm);
    CHECK(p.r_mm <= box.r_max_mm);
    CHECK(p.z_mm >= box.z_min_mm);
    CHECK(p.z_mm <= box.z_max_mm);
  }
}

TEST_CASE("what is no generatrix is refused by name") {
  const std::vector<ControlPoint> good{{0, 10, 1}, {5, 10, 1}, {10, 5, 1}};
  const std::vector<double> knots{0, 0, 0, 1, 1, 1};
  CHECK_FALSE(Profile::find_defect(2, knots, good));
  const auto refused = [&](int degree, std::vector<double> k, std::vector<ControlPoint> p, const char* word) {
    const auto defect = Profile::find_defect(degree, k, p);
    REQUIRE(defect);
    INFO(defect->what << " | " << defect->why);
    CHECK((defect->what + defect->why).find(word) != std::string::npos);
    CHECK_THROWS_AS(Profile(degree, k, p), InputError);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  refused(0, knots, good, "degree");
  refused(10, knots, good, "degree");
  refused(3, knots, good, "degree + 1");
  refused(2, {0, 0, 0, 1, 1}, good, "knots");
  refused(2, {0, 0, 0, 1, nan, 1}, good, "finite");
  refused(2, {0, 0, 1, 0, 1, 1}, good, "less than");
  refused(2, {0, 0, 0, 0, 0, 0}, good, "span");
  refused(2, knots, {{0, 10, 1}, {nan, 10, 1}, {10, 5, 1}}, "finite");
  refused(2, knots, {{0, 10, 1}, {5, infinity, 1}, {10, 5, 1}}, "finite");
  refused(2, knots, {{0, 10, 1}, {5, 10, 0}, {10, 5, 1}}, "weight");
  refused(2, knots, {{0, 10, 1}, {5, 10, -1}, {10, 5, 1}}, "weight");
  refused(2, knots, {{0, 10, 1}, {5, 10, nan}, {10, 5, 1}}, "weight");
  refused(2, knots, {{0, 10, 1}, {-5, 10, 1}, {10, 5, 1}}, "crosses the axis");
  refused(2, knots, {{0, 10, 1}, {0, 8, 1}, {0, 5, 1}}, "lies on the axis");
  refused(2, {0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1},
          {{0, 10, 1}, {1, 10, 1}, {2, 9, 1}, {3, 8, 1}, {4, 7, 1}, {5, 6, 1}}, "repeated");
}
