#include "design/constraints.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "design/profile_measures.h"
#include "design/scene.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

const double root_half = std::sqrt(0.5);

/// A quarter of a circle of radius 10 about the origin, from the axis to the rim.
Profile bowl() { return Profile::bezier({{0, 10, 1}, {10, 10, root_half}, {10, 0, 1}}); }
/// The same about (10, 10): it bends away from the axis.
Profile trumpet() { return Profile::bezier({{0, 10, 1}, {0, 0, root_half}, {10, 0, 1}}); }
Profile chords(std::vector<ControlPoint> points) {
  auto knots = Profile::uniform_knots(1, points.size());
  return Profile(1, std::move(knots), std::move(points));
}

const ConstraintState& only(const std::vector<ConstraintState>& list) {
  REQUIRE(list.size() == 1);
  return list.front();
}

/// A constraint that `profile` keeps at `met` and breaks at `broken` by `violation`.
template <typename Member>
void keeps_and_breaks(const Profile& profile, Member member, double met, double broken, double violation) {
  Constraints constraints;
  constraints.*member = met;
  const auto kept = states(constraints, profile);
  CHECK(only(kept).violation == 0);
  CHECK(design::violation(constraints, profile) == 0);
  constraints.*member = broken;
  const auto lost = states(constraints, profile);
  CHECK(only(lost).violation == Approx(violation).epsilon(1e-9));
  CHECK(design::violation(constraints, profile) == Approx(violation / only(lost).scale).epsilon(1e-9));
}

}  // namespace

TEST_CASE("sizes are the curve's own, not its control points'") {
  // the parabola's top is at half the height of its middle point, and its range in r is exact too
  const Profile arch = Profile::bezier({{2, 0, 1}, {5, 8, 1}, {6, 0, 1}});
  keeps_and_breaks(arch, &Constraints::rim_radius_min_mm, 6.0, 6.5, 0.5);
  keeps_and_breaks(arch, &Constraints::rim_radius_max_mm, 6.0, 5.5, 0.5);
  keeps_and_breaks(arch, &Constraints::height_max_mm, 4.0, 3.75, 0.25);
  keeps_and_breaks(arch, &Constraints::opening_min_mm, 2.0, 2.5, 0.5);
  keeps_and_breaks(bowl(), &Constraints::envelope_radius_mm, 10.0, 8.0, 2.0);
  Constraints box;
  box.envelope_low_mm = -1;
  box.envelope_high_mm = 4.0;
  CHECK(violation(box, arch) == 0);
  box.envelope_low_mm = 0.5;
  box.envelope_high_mm = 3.0;
  const auto both = states(box, arch);
  REQUIRE(both.size() == 2);
  CHECK(both[0].violation == Approx(0.5));
  CHECK(both[1].violation == Approx(1.0));
  CHECK(violation(both) == Approx(1.5 / 2.5));
}

TEST_CASE("the least radius of curvature of circles, of a parabola between samples, and of corners") {
  keeps_and_breaks(bowl(), &Constraints::curvature_radius_min_mm, 10 * (1 - 1e-11), 11.0, 1.0);
  // quadratic Bezier: the cross product of velocity and acceleration is constant, the speed least where the
  // hodograph's chord is nearest to 0
  const double pr = 4, pz = 10, qr = 6, qz = -7, cross = std::abs(pr * qz - pz * qr);
  const double slowest = 2 * cross / std::hypot(qr - pr, qz - pz);
  const double exact = slowest * slowest * slowest / (4 * cross);
  const Profile parabola = Profile::bezier({{0, 0, 1}, {pr, pz, 1}, {pr + qr, pz + qz, 1}});
  CHECK(least_curvature_radius_mm(parabola) == Approx(exact).epsilon(1e-9));
  CHECK(least_curvature_radius_mm(chords({{0, 5, 1}, {5, 5, 1}})) == std::numeric_limits<double>::infinity());
  CHECK(least_curvature_radius_mm(chords({{0, 5, 1}, {5, 5, 1}, {8, 2, 1}})) == 0);
}

TEST_CASE("draft is a cone's half angle, whichever end comes first, and an undercut is negative") {
  const double half_angle = std::atan2(3, 4);
  const Profile cone = chords({{2, 0, 1}, {5, 4, 1}});
  keeps_and_breaks(cone, &Constraints::draft_angle_min_rad, half_angle - 0.01, half_angle + 0.1, 0.1);
  CHECK(least_draft_rad(chords({{5, 4, 1}, {2, 0, 1}})) == Approx(half_angle));
  CHECK(least_draft_rad(chords({{2, 0, 1}, {5, 4, 1}, {4, 6, 1}})) == Approx(-std::atan2(1, 2)));
  CHECK(least_draft_rad(chords({{3, 0, 1}, {3, 6, 1}})) == Approx(0).margin(1e-15));
  CHECK(least_draft_rad(bowl()) == Approx(0).margin(1e-12));  // vertical at its rim
  CHECK(least_draft_rad(chords({{0, 5, 1}, {5, 5, 1}})) == Approx(pi / 2));
}

TEST_CASE("a wall folds where the mirror bends towards it, and where it meets the axis") {
  CHECK(greatest_wall_mm(bowl(), true) == std::numeric_limits<double>::infinity());
  CHECK(greatest_wall_mm(bowl(), false) == Approx(10).epsilon(1e-9));
  CHECK(greatest_wall_mm(trumpet(), true) == Approx(10).epsilon(1e-9));
  const Profile tube = chords({{3, 9, 1}, {3, 1, 1}});
  CHECK(greatest_wall_mm(tube, false) == Approx(3));
  CHECK(greatest_wall_mm(tube, true) == std::numeric_limits<double>::infinity());
  const Profile corner = chords({{0, 5, 1}, {5, 5, 1}, {8, 2, 1}});  // turns towards the axis
  CHECK(greatest_wall_mm(corner, false) == 0);
  CHECK(greatest_wall_mm(corner, true) == std::numeric_limits<double>::infinity());
  Constraints constraints;
  constraints.wall_outside = false;
  constraints.wall_mm = 9.9;
  CHECK(violation(constraints, bowl()) == 0);
  constraints.wall_mm = 12;
  CHECK(violation(constraints, bowl()) == Approx(2.0 / 12));
}

TEST_CASE("a loop is found with its length, and a polygon that advances proves that there is none") {
  // r - 6 = -3 t + 44 t^3 with t = s - 1/2, and z is even in t: the curve meets itself where that is 0
  const Profile looped = Profile::bezier({{2, 0, 1}, {12, 8, 1}, {0, 8, 1}, {10, 0, 1}});
  const double half = std::sqrt(3.0 / 44);
  const auto length = [&](double from, double to) {  // Simpson's rule
    double sum = 0;
    const int steps = 2000;
    for (int i = 0; i <= steps; ++i) {
      const MeridianPoint p = looped.at(from + (to - from) * i / steps);
      sum += std::hypot(p.dr, p.dz) * (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2);
    }
    return sum * (to - from) / steps / 3;
  };
  const Loops found = loops(looped);
  // at the loop's tip a chord turns by a quarter of a radian, which leaves it 1 / (16 * 24) short
  CHECK(found.share == Approx(length(0.5 - half, 0.5 + half) / length(0, 1)).epsilon(1.0 / (16 * 24)));
  CHECK_FALSE(found.certified);
  const Loops arch = loops(Profile::bezier({{2, 0, 1}, {4, 8, 1}, {8, 8, 1}, {10, 0, 1}}));
  CHECK(arch.share == 0);
  CHECK(arch.certified);
  const Loops wavy = loops(Profile::bezier({{2, 0, 1}, {7, 8, 1}, {5, 8, 1}, {7, -1, 1}, {6, -2, 1}}));
  CHECK(wavy.share == 0);
}

TEST_CASE("the share of the landing map that runs backwards, by hand") {
  // flat, then at 45 degrees: rays land from 0 to 15, jump to -5 and run on to 10
  const Profile facets = chords({{0, 10, 1}, {5, 10, 1}, {10, 5, 1}});
  const double size = 7;
  const double far = std::atan(15 / size), back = std::atan(5 / size), end = std::atan(10 / size);
  const double way = far + (far + back) + (end + back);
  CHECK(backward_share(facets, 5, 0, size) == Approx(0.5 * (way - end) / way).epsilon(1e-9));
  // a source in the focus: all rays run parallel to the axis and land in order
  CHECK(backward_share(Profile::bezier({{0, 10, 1}, {5, 10, 1}, {10, 5, 1}}), 5, 0, size) == 0);
  // a smooth wave folds the light: from two samples of each turn alone the way would come out too short
  const Profile wave = Profile::bezier({{0, 10, 1}, {3, 10, 1}, {5, 13, 1}, {8, 4, 1}, {10, 9, 1}});
  const double share = backward_share(wave, 5, 0, size);
  CHECK(share > 0.1);
  CHECK(backward_share(wave, 5, 0, 1e3 * size) != Approx(share));  // the measure knows the field's size
  Constraints constraints;
  constraints.no_folds = Constraints::Landing{5, 0, size};
  CHECK(violation(constraints, wave) == Approx(share));
  CHECK(violation(constraints, Profile::bezier({{0, 10, 1}, {5, 10, 1}, {10, 5, 1}})) == 0);
  // half way to its centre a sphere's light crosses: spherical aberration
  CHECK(violation(constraints, bowl()) > 0.1);
}

TEST_CASE("what is broken never beats what is not, and more broken is worse") {
  CHECK(infeasible_objective(1e-12) > 1e30);
  CHECK(infeasible_objective(0.5) > infeasible_objective(0.49999));
  CHECK(infeasible_objective(1e6) < std::numeric_limits<double>::infinity());
}

TEST_CASE("limits in any unit are kept by what was written in that unit, and the words name them") {
  const std::string text =
      "unit = \"in\"\n[source]\nposition = [0, 0, 5]\npower = 1\n[reflector]\npoints = [[0.1, 10], [5, 10], "
      "[9.7, 5.3]]\n[near_field]\nradius = 5\n[constraints]\nrim_radius_max = 9.7\nopening_min = 0.1\n"
      "draft_angle_min = 60\nenvelope_z = [5.3, 10]\n";
  const Scene scene = make_scene(Settings::parse(text, "s.toml", scene_keys()));
  const auto list = states(scene.constraints, scene.profile);
  REQUIRE(list.size() == 5);
  for (const ConstraintState& state : list)
    CHECK((state.violation == 0) == (state.dimension != Dimension::angle));
  // the steepest place is the rim: atan(4.7 / 4.7) = 45 degrees
  CHECK(sentence(list, scene.unit) ==
        "Constraints that are not satisfied: draft_angle_min is 45 deg, at least 60 is allowed (15 deg too "
        "little).");
  CHECK(sentence({}, scene.unit).empty());
}

TEST_CASE("constraints that exclude each other or cannot be judged are refused") {
  const std::string base =
      "[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n[near_field]\nradius = 5\n[source]\npower = 1\n";
  const auto refused = [&](const std::string& more, const std::string& part) {
    CHECK_THROWS_WITH(make_scene(Settings::parse(base + more, "s.toml", scene_keys())),
                      Catch::Contains(part));
  };
  refused("position = [0, 0, 5]\n[constraints]\nrim_radius_min = 8\nrim_radius_max = 7\n", "leaves no room");
  refused("position = [0, 0, 5]\n[constraints]\nenvelope_z = [5, 5]\n", "leaves no room");
  refused("position = [1, 0, 5]\n[constraints]\nno_folds = true\n", "cannot be judged here");
}
