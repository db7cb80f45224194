#include "sim/field_breaks.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "cad/engines.h"
#include "sim/bandwidth_ladder.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

/// Focus at (0, 50), rim of radius 100 at z = 50.
Profile paraboloid() { return Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}); }

struct Asked {
  Profile profile = paraboloid();
  NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, 60);
  Vector3 source_mm = {0, 0, 50};
  Material mirror = {};
  UnknownBreaks unknown = UnknownBreaks::edges_and_folds;
};

SmoothReach reach_of(const Asked& asked) {
  const auto mirror = cad::make_meridian_reflector(asked.profile);
  const PointSource source(asked.source_mm, 10);
  return find_breaks({source, *mirror, asked.mirror, asked.field}, asked.unknown);
}

bool on_patch(const SmoothReach& reach, const std::string& word) {
  UNSCOPED_INFO(reach.clear_mm << " mm to " << reach.nearest.value_or("nothing"));
  return reach.clear_mm == 0 && reach.nearest && reach.nearest->find(word) != std::string::npos;
}

NearField disc(double x_mm, double z_mm, double radius_mm, std::optional<Material> material = {}) {
  return NearField::disc({x_mm, 0, z_mm}, {0, 0, 1}, radius_mm, material);
}

}  // namespace

TEST_CASE("the beam's edge is as far from the patch as it is") {
  // A collimated beam of radius 100: the distance is known, less the chord's doubt of 2 mm.
  for (const double radius_mm : {20.0, 60.0, 90.0}) {
    const SmoothReach reach = reach_of({.field = disc(0, 0, radius_mm)});
    CHECK(reach.clear_mm <= 100 - radius_mm);
    CHECK(reach.clear_mm >= 100 - radius_mm - 2);
    CHECK(reach.nearest->find("edge") != std::string::npos);
  }
  const SmoothReach leaning = reach_of(
      {.field = NearField::rectangle({10, 0, -40}, {0, 0.5, 0.8660254037844386}, {1, 0, 0}, 90, 70)});
  CHECK(leaning.clear_mm > 30);  // the corner (55, 35 / ...) lies 38 mm from the beam's ellipse
  CHECK(leaning.clear_mm < 45);
  // A little off the focus the edge moves, and the light stays smooth.
  CHECK(reach_of({.source_mm = {3, 0, 50}}).clear_mm > 30);
}

TEST_CASE("an edge across the patch is found, wherever it comes from") {
  CHECK(on_patch(reach_of({.field = disc(70, 0, 40)}), "edge"));                           // across it
  CHECK(on_patch(reach_of({.field = disc(0, 0, 130)}), "edge"));                           // round it
  CHECK(on_patch(reach_of({.field = disc(0, 0, 130), .source_mm = {3, 0, 50}}), "edge"));  // no symmetry
  const Profile hole = Profile::bezier({{30, 91, 1}, {60, 82, 1}, {100, 50, 1}});          // of a lamp's neck
  CHECK(on_patch(reach_of({.profile = hole, .field = disc(0, 0, 60)}), "edge"));
  // Two arcs with one tangent, but other curvatures.
  const Profile joined(2, {0, 0, 0, 0.5, 0.5, 1, 1, 1},
                       {{0, 100, 1}, {25, 100, 1}, {50, 87.5, 1}, {90, 67.5, 1}, {100, 50, 1}});
  CHECK(on_patch(reach_of({.profile = joined}), "edge"));
  // Rings know where edges land; the light between them is smooth.
  CHECK(reach_of({.field = disc(0, 0, 130), .unknown = UnknownBreaks::folds}).clear_mm == HUGE_VAL);
}

TEST_CASE("a curve cut in two has no edge at the cut") {
  const Profile halves(2, {0, 0, 0, 0.5, 0.5, 1, 1, 1},
                       {{0, 100, 1}, {25, 100, 1}, {50, 87.5, 1}, {75, 75, 1}, {100, 50, 1}});
  CHECK(reach_of({.profile = halves}).clear_mm == Approx(reach_of({}).clear_mm));
}

TEST_CASE("folds and foci are found") {
  const auto folds = UnknownBreaks::folds;
  // A sphere lit from beside its centre: the rays of a ring cross the axis before those inside it.
  const Profile sphere = Profile::bezier({{0, 100, 1}, {50, 100, std::sqrt(0.5)}, {50, 50, 1}});
  CHECK(on_patch(reach_of({sphere, disc(0, 40, 20), {0, 0, 62}, {}, folds}), "fold"));
  // An ellipsoid's image of its focus: all light in one point. Far from it the light is smooth.
  const Profile ellipsoid = Profile::bezier({{0, 100, 1}, {60, 100, std::sqrt(0.5)}, {60, 0, 1}});
  CHECK(on_patch(reach_of({ellipsoid, disc(0, -80, 10), {0, 0, 80}, {}, folds}), "fold"));
  CHECK(reach_of({ellipsoid, disc(0, -200, 10), {0, 0, 80}, {}, folds}).clear_mm > 5);
}

TEST_CASE("what a grid of rays cannot tell counts as a break") {
  CHECK(on_patch(reach_of({.mirror = {0.5, 0.3}}), "through the mirror"));
  CHECK(on_patch(reach_of({.field = disc(0, 0, 60, Material::matt(0.5))}), "real"));
  // To rings a real floor is no riddle, unless it stands before the source.
  const auto rings = UnknownBreaks::folds;
  CHECK(reach_of({.field = disc(0, 0, 60, Material::matt(0.5)), .unknown = rings}).clear_mm == HUGE_VAL);
  CHECK(on_patch(reach_of({.field = disc(0, 60, 10, Material::matt(0.5)), .unknown = rings}), "shadow"));
  // A deep mirror lights itself.
  const Profile deep = Profile::bezier({{0, 100, 1}, {60, 100, 1}, {60, -100, 1}});
  CHECK(on_patch(reach_of({.profile = deep, .field = disc(0, -150, 30)}), "more than once"));
}
