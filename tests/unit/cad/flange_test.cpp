#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "cad/opening.h"
#include "cad/shape.h"
#include "support/cad/lamp_mirror.h"
#include "support/cad/sample_profiles.h"

using namespace catoptric;
using cad::Flange;
using cad::Wall;
using cad::WallSide;
using test::LampMirror;

namespace {

constexpr double rel = 1e-8;  // ten times what shape_figures promises for areas and volumes

std::string refusal(const Profile& profile, const Wall& wall) {
  try {
    cad::shape_figures(profile, wall);
  } catch (const CadError& error) {
    CHECK(!error.parts().hint.empty());
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a mirror with opening, wall and flange has the area and volume of its section's sums") {
  const auto check = [](const LampMirror& mirror, int faces) {
    const auto figures =
        cad::shape_figures(cad::with_opening(test::paraboloid(), mirror.opening_mm), mirror.wall());
    CAPTURE(mirror.wall_mm, mirror.flange_thickness_mm);
    CHECK(figures.is_valid);
    CHECK(figures.face_count == faces);
    CHECK(figures.volume_mm3 == Approx(mirror.volume_mm3()).epsilon(rel));
    CHECK(figures.area_mm2 == Approx(mirror.area_mm2()).epsilon(rel));
  };
  // Optical surface, back, edge of the opening, three of the flange; a thin flange leaves a part of the edge.
  check({10, 1, 8, 1}, 6);
  check({10, 1, 8, 2}, 6);
  check({25, 3, 20, 10}, 6);
  check({10, 3, 8, 1}, 7);
}

TEST_CASE("a flange on a half sphere, whose rim runs along the axis: closed form") {
  // The flange beside what it covers of the shell's outer part, over 0 < z < t.
  const double t = 4, width = 10;
  const auto figures = cad::shape_figures(test::hemisphere(50), Wall{2, WallSide::outside, Flange{width, t}});
  const double shell = 2 * pi / 3 * (52. * 52 * 52 - 50. * 50 * 50);
  const double under = pi * (52. * 52 * t - t * t * t / 3);  // of the outer sphere up to t
  CHECK(figures.is_valid);
  CHECK(figures.volume_mm3 == Approx(shell + pi * 60 * 60 * t - under).epsilon(rel));
}

TEST_CASE(
    "a flange looks away from the light also where the mirror opens upwards, and a flat mirror has one too") {
  const Profile up = Profile::bezier({{0, 0, 1}, {50, 0, 1}, {100, 50, 1}});
  const Wall wall{1, WallSide::outside, Flange{8, {}}};  // as thick as the wall
  CHECK(cad::shape_figures(up, wall).volume_mm3 ==
        Approx(cad::shape_figures(test::paraboloid(), wall).volume_mm3).epsilon(rel));
  const Profile disc = Profile::bezier({{0, 10, 1}, {50, 10, 1}});
  CHECK(cad::shape_figures(disc, wall).volume_mm3 == Approx(pi * 58 * 58).epsilon(rel));
}

TEST_CASE("a flange without a place is refused with the reason") {
  const auto with = [](double width, double thickness) {
    return Wall{1, WallSide::outside, Flange{width, thickness}};
  };
  CHECK_THAT(refusal(test::paraboloid(), with(0.3, 1)), Catch::Contains("ends within the wall"));
  CHECK_THAT(refusal(test::paraboloid(), with(8, 60)), Catch::Contains("does not fit"));
  for (const double bad : {0.0, -1.0, 1e-7, std::nan(""), HUGE_VAL}) {
    CHECK_THAT(refusal(test::paraboloid(), with(bad, 1)), Catch::Contains("cannot be built"));
    CHECK_THAT(refusal(test::paraboloid(), with(8, bad)), Catch::Contains("cannot be built"));
  }
  CHECK_THAT(refusal(test::paraboloid(), {1, WallSide::inside, Flange{8, 1}}), Catch::Contains("inside"));
  const Profile back = Profile::bezier({{100, 50, 1}, {50, 100, 1}, {0, 100, 1}});
  CHECK_THAT(refusal(back, with(8, 1)), Catch::Contains("no rim"));
  // Closes in towards its rim: the wall would stand beyond the flange's face.
  const Profile bulb = Profile::bezier({{0, 100, 1}, {120, 100, 1}, {120, 20, 1}, {60, 0, 1}});
  CHECK(!refusal(bulb, with(8, 3)).empty());
}
