#include "sim/projection_map.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/random_stream.h"
#include "base/units.h"
#include "support/analytic_reflectors.h"
#include "support/flat_mirror.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

Vector3 random_direction(RandomStream& stream) {
  const double cosine = 2 * stream.uniform() - 1, azimuth = 2 * pi * stream.uniform();
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/// Directions that meet the mirror but are not in the map, out of `count` directions aimed at random points
/// of the mirror and its rim; and the share of the map's own directions that meet the mirror.
int missed_directions(const Reflector& mirror, const Vector3& source, const ProjectionMap& map, int count) {
  const auto probe = mirror.probe();
  const Profile& profile = mirror.profile();
  int missed = 0;
  for (int i = 0; i < count; ++i) {
    RandomStream stream(3, Purpose::test, static_cast<std::uint64_t>(i));
    const double u = i % 4 == 0   ? profile.last_parameter()
                     : i % 4 == 1 ? profile.first_parameter()
                                  : stream.uniform();
    const MeridianPoint at = profile.at(u);
    const double azimuth = 2 * pi * stream.uniform();
    const Vector3 target(at.r_mm * std::cos(azimuth), at.r_mm * std::sin(azimuth), at.z_mm);
    Vector3 direction = (target - source).normalized();
    if (i % 2 == 0) direction = (direction + 1e-3 * random_direction(stream)).normalized();
    if (probe->first_hit({source, direction}, 0) && !map.contains(direction)) ++missed;
  }
  return missed;
}

double hit_share(const Reflector& mirror, const Vector3& source, const ProjectionMap& map) {
  const auto probe = mirror.probe();
  constexpr int side = 300;
  int hits = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      hits += probe->first_hit({source, map.direction((i + 0.5) / side, (j + 0.5) / side)}, 0).has_value();
  return hits / static_cast<double>(side * side);
}

}  // namespace

TEST_CASE("from the axis no direction is missed and hardly one is wasted") {
  const auto paraboloid = test::paraboloid();
  const auto hemisphere = test::half_ellipsoid(50, 50, 50);
  const auto tall = test::half_ellipsoid(20, 30, 200);
  const auto lampshade = test::cone(60, 30, 40, 50);
  const auto tube = test::cone(50, 30, 50, 40);
  const test::FlatMirror flat(100, 30);
  for (const Reflector* mirror :
       {static_cast<const Reflector*>(&paraboloid), static_cast<const Reflector*>(&hemisphere),
        static_cast<const Reflector*>(&tall), static_cast<const Reflector*>(&lampshade),
        static_cast<const Reflector*>(&tube), static_cast<const Reflector*>(&flat)})
    for (double z : {-1e6, -1000.0, 0.0, 49.9, 50.0, 50.1, 70.0, 99.999, 300.0, 1e5}) {
      const Vector3 source(0, 0, z);
      const auto map = ProjectionMap::towards(mirror->profile(), source);
      CAPTURE(mirror->engine(), mirror->profile().r_max_mm(), z, map.solid_angle_sr());
      CHECK(missed_directions(*mirror, source, map, 2000) == 0);
      // 0.5 % of waste by construction; the count on a grid of 300 bands of directions adds one band more
      if (map.solid_angle_sr() > 1e-9) CHECK(hit_share(*mirror, source, map) > 0.99 - 1.0 / 300);
    }
}

TEST_CASE("solid angles of closed forms") {
  const auto half = ProjectionMap::towards(test::paraboloid().profile(), {0, 0, 50});
  CHECK(half.solid_angle_sr() == Approx(2 * pi).epsilon(1e-12));
  CHECK(ProjectionMap::whole_sphere().solid_angle_sr() == 4 * pi);
  const auto flat = ProjectionMap::towards(test::FlatMirror(100, 75).profile(), {0, 0, 0});
  CHECK(flat.solid_angle_sr() == Approx(2 * pi * (1 - 0.8)).epsilon(5e-3));
  const auto closed = ProjectionMap::towards(test::sphere(0, 50, -50).profile(), {0, 0, 20});
  CHECK(closed.solid_angle_sr() == Approx(4 * pi).epsilon(1e-12));
}

TEST_CASE("off the axis no direction is missed") {
  const auto paraboloid = test::paraboloid();
  const auto lampshade = test::cone(60, 30, 40, 50);
  const test::FlatMirror flat(100, 30);
  for (const Reflector* mirror :
       {static_cast<const Reflector*>(&paraboloid), static_cast<const Reflector*>(&lampshade),
        static_cast<const Reflector*>(&flat)})
    for (const Vector3& source : {Vector3(1e-9, 0, 50), Vector3(5, 3, 50), Vector3(30, 0, 60),
                                  Vector3(0, 80, 20), Vector3(-300, 40, 75), Vector3(0, 1e5, 75),
                                  Vector3(10, 0, -1e4), Vector3(0, -59.9, 30), Vector3(20, 20, 99)}) {
      const auto map = ProjectionMap::towards(mirror->profile(), source);
      CAPTURE(mirror->engine(), mirror->profile().r_max_mm(), source.transpose(), map.solid_angle_sr());
      CHECK(missed_directions(*mirror, source, map, 2000) == 0);
      CHECK(map.solid_angle_sr() <= 4 * pi * (1 + 1e-12));
    }
}

TEST_CASE("off the axis most directions of the map meet the mirror") {
  const auto paraboloid = test::paraboloid();
  for (const Vector3& source :
       {Vector3(5, 3, 50), Vector3(30, 0, 60), Vector3(-300, 40, 0), Vector3(10, 0, -1e4)}) {
    const auto map = ProjectionMap::towards(paraboloid.profile(), source);
    CAPTURE(source.transpose(), map.solid_angle_sr());
    CHECK(hit_share(paraboloid, source, map) > 0.75);
  }
}

TEST_CASE("a source on the mirror sends everywhere") {
  const auto paraboloid = test::paraboloid();
  CHECK(ProjectionMap::towards(paraboloid.profile(), {0, 0, 100}).solid_angle_sr() == 4 * pi);
  CHECK(ProjectionMap::towards(paraboloid.profile(), {60, 0, 82}).solid_angle_sr() == 4 * pi);
}

TEST_CASE("directions are unit and belong to the map") {
  for (const Vector3& source : {Vector3(0, 0, 50), Vector3(0, 0, -200), Vector3(20, 5, 40)}) {
    const auto map = ProjectionMap::towards(test::paraboloid().profile(), source);
    for (std::uint64_t i = 0; i < 3000; ++i) {
      RandomStream stream(11, Purpose::test, i);
      const double first = stream.uniform(), second = stream.uniform();
      const Vector3 direction = map.direction(first, second);
      CHECK(std::abs(direction.norm() - 1) < 1e-14);
      const Vector3 inwards = map.direction(0.999 * first + 5e-4, second);
      CHECK(map.contains(inwards));
    }
    for (double edge : {0.0, 1 - 0x1p-53}) CHECK(map.direction(edge, edge).allFinite());
  }
}
