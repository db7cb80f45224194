#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "cad/shape.h"
#include "support/cad/sample_profiles.h"

using namespace catoptric;
using cad::Wall;
using cad::WallSide;

namespace {

/// Volume between the generatrix and its parallel at signed distance d to the left, no kinks, by the midpoint
/// rule.
/// @from  Steiner 1840 / Pappus: 2 pi times the integral of (r + t n_r)(1 - k t) over arc length and t in [0,
/// d]
double parallel_volume(const Profile& profile, double d) {
  constexpr int steps = 20000;
  double sum = 0;
  for (const RationalSpan& span : profile.spans())
    for (int i = 0; i < steps; ++i) {
      const MeridianPoint p = evaluate(span, (i + 0.5) / steps);
      const double speed = std::hypot(p.dr, p.dz), normal_r = -p.dz / speed;
      const double curvature = (p.dr * p.ddz - p.dz * p.ddr) / (speed * speed * speed);
      sum +=
          (p.r_mm * d + (normal_r - curvature * p.r_mm) * d * d / 2 - curvature * normal_r * d * d * d / 3) *
          speed / steps;
    }
  return 2 * pi * std::abs(sum);
}

std::string refusal(const Profile& profile, const std::optional<Wall>& wall) {
  try {
    cad::shape_figures(profile, wall);
  } catch (const CadError& error) {
    CHECK(!error.parts().hint.empty());
    return error.what();
  }
  return "";
}

const Profile cylinder = Profile::bezier({{50, 100, 1}, {50, 0, 1}});
const Profile cone = Profile::bezier({{0, 100, 1}, {100, 0, 1}});
const Profile disc = Profile::bezier({{0, 10, 1}, {50, 10, 1}});
constexpr double rel = 1e-8;  // ten times what shape_figures promises for areas and volumes

}  // namespace

TEST_CASE("Areas of the open surface: closed forms") {
  const auto area = [](const Profile& profile) {
    const auto figures = cad::shape_figures(profile, std::nullopt);
    CHECK(figures.is_valid);
    CHECK(figures.face_count == 1);
    CHECK(figures.volume_mm3 == 0);
    return figures.area_mm2;
  };
  // z = h - r^2 / (4 f): (8 pi / 3) f^2 ((1 + R^2 / (4 f^2))^(3/2) - 1), here f = 50, R = 100.
  CHECK(area(test::paraboloid()) == Approx(8 * pi / 3 * 2500 * (std::pow(2, 1.5) - 1)).epsilon(rel));
  CHECK(area(test::hemisphere(50)) == Approx(2 * pi * 2500).epsilon(rel));
  CHECK(area(cone) == Approx(pi * 100 * 100 * std::sqrt(2.)).epsilon(rel));
  CHECK(area(cylinder) == Approx(2 * pi * 50 * 100).epsilon(rel));
  CHECK(area(disc) == Approx(pi * 2500).epsilon(rel));
  for (int degree = 2; degree <= 9; ++degree) {
    const Profile profile = test::wavy_profile(degree, true);
    CHECK(area(profile) == Approx(profile.area_mm2()).epsilon(rel));
  }
}

TEST_CASE("Volumes of walled mirrors: closed forms") {
  const auto volume = [](const Profile& profile, const Wall& wall, int faces) {
    const auto figures = cad::shape_figures(profile, wall);
    CHECK(figures.is_valid);
    CHECK(figures.face_count == faces);
    return figures.volume_mm3;
  };
  CHECK(volume(cylinder, {2}, 4) == Approx(pi * (52. * 52 - 50. * 50) * 100).epsilon(rel));
  CHECK(volume(cylinder, {2, WallSide::inside}, 4) == Approx(pi * (50. * 50 - 48. * 48) * 100).epsilon(rel));
  CHECK(volume(disc, {2}, 3) == Approx(pi * 2500 * 2).epsilon(rel));
  CHECK(volume(test::hemisphere(50), {2}, 3) ==
        Approx(2 * pi / 3 * (std::pow(52, 3) - std::pow(50, 3))).epsilon(rel));
  CHECK(volume(test::hemisphere(50), {2, WallSide::inside}, 3) ==
        Approx(2 * pi / 3 * (std::pow(50, 3) - std::pow(48, 3))).epsilon(rel));
  // Cone: parallel side, and a spherical tip of the wall's radius (sector of half-angle 45 degrees).
  CHECK(volume(cone, {2}, 4) ==
        Approx(parallel_volume(cone, 2) + 2 * pi / 3 * 8 * (1 - std::sqrt(0.5))).epsilon(rel));
  CHECK(volume(test::paraboloid(), {2}, 3) == Approx(parallel_volume(test::paraboloid(), 2)).epsilon(rel));
  CHECK(volume(test::paraboloid(), {2, WallSide::inside}, 3) ==
        Approx(parallel_volume(test::paraboloid(), -2)).epsilon(rel));
}

TEST_CASE("A mirror that opens upwards or runs from the rim has its wall outside too") {
  const Profile up = Profile::bezier({{0, 0, 1}, {50, 0, 1}, {100, 50, 1}});
  const Profile back = Profile::bezier({{100, 50, 1}, {50, 100, 1}, {0, 100, 1}});
  const double outside = cad::shape_figures(test::paraboloid(), Wall{2}).volume_mm3;
  CHECK(cad::shape_figures(up, Wall{2}).volume_mm3 == Approx(outside).epsilon(rel));
  CHECK(cad::shape_figures(back, Wall{2}).volume_mm3 == Approx(outside).epsilon(rel));
}

TEST_CASE("Facets: arcs of the wall's radius at the kinks") {
  const std::vector<ControlPoint> points{{10, 100, 1}, {40, 95, 1}, {80, 60, 1}, {85, 10, 1}};
  const Profile facets(1, {0, 0, 0.3, 0.6, 1, 1}, points);
  const double t = 2;
  double expected = parallel_volume(facets, t);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const auto slope = [&](std::size_t k) {
      return std::atan2(points[k + 1].z_mm - points[k].z_mm, points[k + 1].r_mm - points[k].r_mm);
    };
    // Sector between the two normals (a right angle left of the facets), revolved: Pappus.
    const double from = slope(i) + pi / 2, to = slope(i - 1) + pi / 2;
    expected +=
        2 * pi * (points[i].r_mm * t * t / 2 * (to - from) + t * t * t / 3 * (std::sin(to) - std::sin(from)));
  }
  const auto figures = cad::shape_figures(facets, Wall{t});
  CHECK(figures.is_valid);
  CHECK(figures.face_count == 3 + 3 + 2 + 2 - 2);  // facets are one face inside; 3 outside, 2 arcs, 2 ends
  CHECK(figures.volume_mm3 == Approx(expected).epsilon(1e-6));  // the inner face has kinks: see shape_figures
}

TEST_CASE("The wall is as thick for a part of any size") {
  for (const double scale : {1e-4, 1e-2, 1.0, 1e2, 3e3}) {
    const auto figures = cad::shape_figures(test::paraboloid(scale), Wall{2 * scale});
    const double expected = parallel_volume(test::paraboloid(), 2) * scale * scale * scale;
    CAPTURE(scale);
    // The outer side is within 1e-9 of the part or 1e-7 mm: that times its area.
    const double error = std::max(1e-9 * test::paraboloid(scale).diagonal_mm(), 1e-7) * 4e4 * scale * scale;
    CHECK(std::abs(figures.volume_mm3 - expected) < error + rel * expected);
  }
}

TEST_CASE("Walls that cannot be are refused, with the place") {
  CHECK_THAT(refusal(test::hemisphere(50), Wall{60, WallSide::inside}), Catch::Contains("folds"));
  CHECK_THAT(refusal(cylinder, Wall{51, WallSide::inside}), Catch::Contains("axis"));
  CHECK_THAT(refusal(cone, Wall{2, WallSide::inside}), Catch::Contains("pointed vertex"));
  const Profile facets(1, {0, 0, 0.5, 1, 1}, {{10, 100, 1}, {60, 90, 1}, {80, 40, 1}});
  CHECK_THAT(refusal(facets, Wall{2, WallSide::inside}),
             Catch::Contains("kink") && Catch::Contains("r = 60"));
  CHECK_THAT(refusal(Profile::bezier({{0, 100, 1}, {0, 100, 1}, {50, 100, 1}, {100, 50, 1}}), Wall{2}),
             Catch::Contains("coincide"));
  // A hairpin whose two sides are 4 mm apart: 1 mm of wall fits between them, 3 mm do not.
  const Profile hairpin = Profile::bezier({{20, 0, 1}, {20, 300, 1}, {24, 300, 1}, {24, 0, 1}});
  CHECK(refusal(hairpin, Wall{3, WallSide::inside}) != "");
  const Profile sphere(
      2, {0, 0, 0, 0.5, 0.5, 1, 1, 1},
      {{0, 50, 1}, {50, 50, std::sqrt(0.5)}, {50, 0, 1}, {50, -50, std::sqrt(0.5)}, {0, -50, 1}});
  CHECK_THAT(refusal(sphere, Wall{2}), Catch::Contains("closed"));
  CHECK(cad::shape_figures(sphere, std::nullopt).area_mm2 == Approx(4 * pi * 2500).epsilon(rel));
  for (const double thickness : {0.0, -1.0, 1e-9, std::nan(""), HUGE_VAL})
    CHECK_THAT(refusal(test::paraboloid(), Wall{thickness}), Catch::Contains("cannot be built"));
}

TEST_CASE("Parts beyond what CAD kernels tell apart are refused by size") {
  CHECK_THAT(refusal(test::paraboloid(1e-6), std::nullopt), Catch::Contains("unit of length"));
  CHECK_THAT(refusal(test::paraboloid(1e4), std::nullopt), Catch::Contains("unit of length"));
}
