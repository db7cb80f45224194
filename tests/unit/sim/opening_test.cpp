#include "sim/opening.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/random_stream.h"
#include "base/units.h"
#include "cad/engines.h"
#include "sim/scatter.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

Profile bowl() { return Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}); }

}  // namespace

TEST_CASE(
    "a bowl has an opening, either way up and listed from either end, with a hole or a point for apex") {
  CHECK(Opening::of(bowl()));
  CHECK(Opening::of(Profile::bezier({{100, 50, 1}, {50, 100, 1}, {0, 100, 1}})));
  CHECK(Opening::of(Profile::bezier({{0, 0, 1}, {50, 0, 1}, {100, 50, 1}})));
  CHECK(Opening::of(Profile::bezier({{40, 50, 1}, {60, 30, 1}})));             // a conical band
  CHECK(Opening::of(Profile::bezier({{0, 50, 1}, {60, 30, 1}})));              // a cone with its tip
  CHECK(Opening::of(Profile::bezier({{50, 50, 1}, {50, 30, 1}})));             // a cylinder
  CHECK(Opening::of(Profile::bezier({{0, 60, 1}, {90, 60, 9}, {90, 0, 1}})));  // a heavy weight
}

TEST_CASE("what is no bowl has none") {
  CHECK_FALSE(
      Opening::of(Profile::bezier({{0, 100, 1}, {50, 110, 1}, {100, 50, 1}})));  // a dimple in the apex
  CHECK_FALSE(Opening::of(Profile::bezier({{0, 100, 1}, {120, 100, 1}, {100, 50, 1}})));  // a narrowed mouth
  CHECK_FALSE(Opening::of(Profile::bezier({{0, 100, 1}, {50, 60, 1}, {100, 50, 1}})));    // bends outwards
  CHECK_FALSE(Opening::of(
      Profile::bezier({{0, 100, 1}, {40, 100, 1}, {40, 60, 1}, {80, 60, 1}, {100, 40, 1}})));  // a step
  CHECK_FALSE(Opening::of(Profile::bezier({{0, 100, 1}, {50, 100, 1}, {0, 0, 1}})));           // closed
}

TEST_CASE("through the mouth or not, and never from the rim's own height") {
  const auto opening = Opening::of(bowl());
  REQUIRE(opening);
  CHECK(opening->lets_out({{30, 0, 97.75}, {0, 0, -1}}));
  CHECK_FALSE(opening->lets_out({{30, 0, 97.75}, {0, 0, 1}}));
  CHECK_FALSE(opening->lets_out({{30, 0, 97.75}, Vector3(-130, 0, -40).normalized()}));  // meets the far wall
  CHECK_FALSE(opening->lets_out({{100, 0, 50}, {0, 0, -1}}));
  CHECK_FALSE(opening->lets_out({{30, 0, 97.75}, {1, 0, 0}}));
}

TEST_CASE("what an opening lets out meets the mirror no more, whatever the bowl") {
  // Mirrors and rays at random; the engine, which knows nothing of the proof, is the judge.
  std::size_t let_out = 0, kept = 0;
  for (std::uint64_t shape = 0; shape < 300; ++shape) {
    RandomStream random(7, Purpose::test, shape);
    // steps outwards whose steepness grows make a convex polygon
    const int degree = 1 + static_cast<int>(4 * random.uniform());
    std::vector<ControlPoint> points{{shape % 3 == 0 ? 20 * random.uniform() : 0.0, 100, 1}};
    double angle = 0;
    for (int i = 0; i < degree; ++i) {
      if (i > 0 || points[0].r_mm > 0) angle += (0.5 * pi - angle) * random.uniform();
      const double step = 10 + 40 * random.uniform();
      points.push_back({points.back().r_mm + step * std::cos(angle),
                        points.back().z_mm - step * std::sin(angle), std::exp(4 * random.uniform() - 2)});
    }
    if (points.back().z_mm == 100) continue;
    const Profile profile = Profile::bezier(points);
    const auto opening = Opening::of(profile);
    REQUIRE(opening);
    const auto mirror = cad::make_meridian_reflector(profile);
    const auto probe = mirror->probe();
    for (int i = 0; i < 200; ++i) {
      const MeridianPoint at = profile.at(random.uniform());
      const double polar = std::acos(2 * random.uniform() - 1), azimuth = 2 * pi * random.uniform();
      const Ray ray{
          {at.r_mm, 0, at.z_mm},
          {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)}};
      if (!opening->lets_out(ray)) {
        ++kept;
        continue;
      }
      ++let_out;
      // a start on the curve is good to rounding; its own surface is left behind within the tracer's lift
      CHECK_FALSE(probe->first_hit(ray, 1e-6));
    }
  }
  CHECK(let_out > 5000);  // the test is not empty
  CHECK(kept > 5000);
}
