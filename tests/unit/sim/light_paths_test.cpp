#include "sim/light_paths.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/flat_mirror.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

PhotonOptions photons(std::uint64_t count) {
  PhotonOptions options;
  options.photons = count;
  return options;
}

}  // namespace

TEST_CASE("a path goes from the source over the mirror to where its image says it lands") {
  const test::FlatMirror mirror(100, 50);
  const Vector3 source_mm(3, -4, 20);
  const PointSource source(source_mm, 1);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 400);
  const auto paths = light_paths({source, mirror, {}, field}, photons(200));
  REQUIRE(paths.size() == 200);
  int met = 0;
  for (const LightPath& path : paths) {
    REQUIRE_FALSE(path.corners_mm.empty());
    CHECK(path.corners_mm.front() == source_mm);
    if (!path.met_mirror) continue;
    ++met;
    REQUIRE(path.corners_mm.size() == 2);
    REQUIRE(path.leaves_towards);
    REQUIRE(path.landed_mm);
    const Vector3 turn = path.corners_mm[1], image_mm(3, -4, 180);
    CHECK(turn.z() == Approx(100));
    CHECK((*path.leaves_towards - (turn - image_mm).normalized()).norm() < 1e-12);
    CHECK((*path.landed_mm - (image_mm + (turn - image_mm) * 180 / 80)).norm() < 1e-9);
  }
  CHECK(met > 150);
}

TEST_CASE("a path ends on the real near field that takes it, and lands nowhere beside an invisible one") {
  const test::FlatMirror mirror(100, 50);
  const PointSource source({0, 0, 20}, 1);
  const auto aside = NearField::disc({1e4, 0, 0}, {0, 0, 1}, 1);
  for (const LightPath& path : light_paths({source, mirror, {}, aside}, photons(50)))
    CHECK_FALSE(path.landed_mm);
  const auto black = NearField::disc({0, 0, 0}, {0, 0, 1}, 400, Material{0, 0});
  int met = 0;
  for (const LightPath& path : light_paths({source, mirror, {}, black}, photons(50))) {
    if (!path.met_mirror) continue;
    ++met;
    CHECK_FALSE(path.leaves_towards);
    REQUIRE(path.landed_mm);
    CHECK((*path.landed_mm - path.corners_mm.back()).norm() < 1e-9);
  }
  CHECK(met > 10);
}
