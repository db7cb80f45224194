#include "cad/opening.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/cad/sample_profiles.h"

using namespace catoptric;

namespace {

/// Largest distance between the two curves over the parameters of the cut one.
double apart(const Profile& cut, const Profile& whole) {
  double greatest = 0;
  for (int i = 0; i <= 200; ++i) {
    const double u =
        cut.first_parameter() + (cut.last_parameter() - cut.first_parameter()) * static_cast<double>(i) / 200;
    const MeridianPoint a = cut.at(u), b = whole.at(u);
    greatest = std::max(greatest, std::hypot(a.r_mm - b.r_mm, a.z_mm - b.z_mm));
  }
  return greatest;
}

}  // namespace

TEST_CASE("an opening leaves the paraboloid's outer part: closed form") {
  const Profile cut = cad::with_opening(test::paraboloid(), 10);
  REQUIRE(cut.points().size() == 3);
  // The part of z = 100 - r^2 / 200 over [10, 100]: its middle control point is where the end tangents meet.
  const std::vector<ControlPoint> expected{{10, 99.5, 1}, {55, 95, 1}, {100, 50, 1}};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(std::abs(cut.points()[i].r_mm - expected[i].r_mm) < 1e-13);
    CHECK(std::abs(cut.points()[i].z_mm - expected[i].z_mm) < 1e-13);
    CHECK(cut.points()[i].weight == 1);
  }
  CHECK(cut.points().front().r_mm == 10);
}

TEST_CASE("what an opening leaves is the same curve, of every degree, with weights and many spans") {
  for (int degree = 1; degree <= 9; ++degree)
    for (const double radius_mm : {0.5, 17.3, 60.0}) {
      const Profile whole = test::wavy_profile(degree, true);
      const Profile cut = cad::with_opening(whole, radius_mm);
      CAPTURE(degree, radius_mm);
      CHECK(cut.points().front().r_mm == radius_mm);
      CHECK(cut.last_parameter() == whole.last_parameter());
      CHECK(cut.degree() == degree);
      CHECK(apart(cut, whole) < 1e-12 * whole.diagonal_mm());
      CHECK(cad::with_opening(cut, radius_mm) == cut);        // it is there already
      CHECK(cad::with_opening(cut, 0.9 * radius_mm) == cut);  // and more than that
    }
  const Profile kinks = test::multiple_knots_profile();
  CHECK(apart(cad::with_opening(kinks, 30), kinks) < 1e-12 * kinks.diagonal_mm());
  CHECK(apart(cad::with_opening(kinks, kinks.at(0.3).r_mm), kinks) < 1e-12 * kinks.diagonal_mm());
}

TEST_CASE("a mirror written from the rim to the apex loses its end") {
  const Profile whole = Profile::bezier({{100, 50, 1}, {50, 100, 2}, {0, 100, 1}});
  const Profile cut = cad::with_opening(whole, 20);
  CHECK(cut.points().back().r_mm == 20);
  CHECK(cut.points().front() == whole.points().front());
  CHECK(apart(cut, whole) < 1e-12 * whole.diagonal_mm());
}

TEST_CASE("an opening that leaves nothing, more than one piece, or is no radius is refused") {
  for (const double radius_mm : {100.0, 101.0, 0.0, -1.0, std::nan(""), HUGE_VAL})
    CHECK_THROWS_AS(cad::with_opening(test::paraboloid(), radius_mm), InputError);
  // Out to 60, back to 30, out again: an opening of 40 leaves two rings.
  const Profile waist = Profile::bezier({{0, 100, 1}, {150, 90, 1}, {-60, 70, 1}, {100, 50, 1}});
  CHECK_THROWS_WITH(cad::with_opening(waist, 40), Catch::Contains("3 times"));
  // A ring whose inner part dips into the opening and comes out again.
  const Profile ring = Profile::bezier({{50, 100, 1}, {10, 80, 1}, {100, 50, 1}});
  CHECK_THROWS_WITH(cad::with_opening(ring, 45), Catch::Contains("2 times"));
  CHECK(cad::with_opening(ring, 30) == ring);
}
