#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "base/tolerance.h"
#include "cad/engines.h"
#include "cad/meridian_reflector.h"
#include "support/cad/quadric.h"
#include "support/cad/rays.h"

using namespace catoptric;
using namespace catoptric::test;

namespace {

/// Asks one probe after another about the same ray.
std::vector<Hit> meridian_hits(const Profile& profile, const Ray& ray, double beyond_mm = 0) {
  return cad::make_meridian_reflector(profile)->probe()->all_hits(ray, beyond_mm);
}

const Profile paraboloid = Quadric::paraboloid().profile;

/// A ball: two quarters of a circle of radius 5 about (0, 5), from the upper vertex to the lower.
const Profile ball(2, {0, 0, 0, 1, 1, 2, 2, 2},
                   {{0, 10, 1}, {5, 10, std::sqrt(0.5)}, {5, 5, 1}, {5, 0, std::sqrt(0.5)}, {0, 0, 1}});

/// Distance of a hit from a point, over the part's size.
double off(const Profile& profile, const Hit& hit, const Vector3& point) {
  return (hit.point_mm - point).norm() / profile.diagonal_mm();
}

}  // namespace

TEST_CASE("the axial ray meets a smooth vertex once, head-on", "[special]") {
  for (const bool reference : {false, true}) {
    const auto reflector =
        reference ? cad::make_occt_reflector(paraboloid) : cad::make_meridian_reflector(paraboloid);
    const auto probe = reflector->probe();
    INFO(reflector->engine());
    for (const double side : {1.0, -1.0}) {
      const auto hits = probe->all_hits({{0, 0, side > 0 ? 0.0 : 30.0}, {0, 0, side}}, 0);
      REQUIRE(hits.size() == 1);
      CHECK(hits[0].distance_mm == (side > 0 ? 10.0 : 20.0));
      CHECK(hits[0].point_mm == Vector3(0, 0, 10));
      CHECK(hits[0].normal == Vector3(0, 0, -side));
      CHECK(hits[0].parameter == 0);
    }
    CHECK_FALSE(probe->first_hit({{0, 0, 0}, {0, 0, -1}}, 0));
    CHECK_FALSE(probe->first_hit({{0, 0, 10}, {0, 0, 1}}, 1e-9));
  }
}

TEST_CASE("a ray off the axis by any amount meets the vertex region once", "[special]") {
  const auto reflector = cad::make_meridian_reflector(paraboloid);
  const auto own = reflector->probe();
  for (int power = 1; power <= 320; ++power) {
    const double e = std::pow(10.0, -power);
    INFO("off by 1e-" << power);
    // Displaced, tilted, and both, so that it passes the vertex on the other side.
    for (const Ray& ray : {Ray{{e, 0, 0}, {0, 0, 1}}, Ray{{0, 0, 0}, Vector3(e, 0, 1).normalized()},
                           Ray{{-e, e, 0}, Vector3(0.2 * e, -e, 1).normalized()}}) {
      const auto hits = own->all_hits(ray, 0);
      REQUIRE(hits.size() == 1);
      CHECK(backward_error(paraboloid, ray, hits[0]) <= 1e-14 * paraboloid.diagonal_mm());
      const Vector3 normal = Vector3(-hits[0].point_mm.x(), -hits[0].point_mm.y(), -10).normalized();
      CHECK((hits[0].normal - normal).norm() <= 1e-14);
    }
  }
  CHECK(dynamic_cast<const cad::MeridianProbe&>(*own).counts().exact > 600);
}

TEST_CASE("a generatrix that touches the axis between its ends is met there", "[special]") {
  // r = 5 (1 - 2 s)^2: the pole in the middle lies beyond the axis, the curve does not.
  const Profile waist = Profile::bezier({{5, 0, 1}, {-5, 5, 1}, {5, 10, 1}});
  const auto hits = meridian_hits(waist, {{0, 0, -7}, {0, 0, 1}});
  REQUIRE(hits.size() == 1);
  CHECK(off(waist, hits[0], {0, 0, 5}) <= 1e-15);
}

TEST_CASE("an oblique ray aimed at the vertex meets it once", "[special]") {
  const auto reflector = cad::make_meridian_reflector(paraboloid);
  const auto probe = reflector->probe();
  for (std::uint64_t i = 0; i < 3000; ++i) {
    RandomStream random(3, Purpose::test, i);
    const Vector3 origin(6 * random.uniform() - 3, 6 * random.uniform() - 3, 3 * random.uniform());
    const Ray ray{origin, (Vector3(0, 0, 10) - origin).normalized()};
    const auto hits = probe->all_hits(ray, 0);
    REQUIRE(hits.size() == 1);
    CHECK(off(paraboloid, hits[0], {0, 0, 10}) <= 1e-15);
    CHECK((hits[0].normal - Vector3(0, 0, -1)).norm() <= 1e-14);
  }
}

TEST_CASE("a ball is met at both vertices, a pole repeated at the vertex changes nothing", "[special]") {
  const Profile repeated = Profile::bezier({{0, 10, 1}, {0, 10, 1}, {0, 10, 2}, {5, 10, 1}, {10, 5, 1}});
  for (const bool reference : {false, true}) {
    const auto make = reference ? cad::make_occt_reflector : cad::make_meridian_reflector;
    INFO((reference ? "occt" : "meridian"));
    const auto ball_reflector = make(ball);
    const auto hits = ball_reflector->probe()->all_hits({{0, 0, -7}, {0, 0, 1}}, 0);
    REQUIRE(hits.size() == 2);
    CHECK(hits[0].distance_mm == 7);
    CHECK(hits[1].distance_mm == 17);
    CHECK(hits[0].parameter == 2);
    CHECK((hits[0].normal - Vector3(0, 0, -1)).norm() <= 1e-15);
    CHECK((hits[1].normal - Vector3(0, 0, -1)).norm() <= 1e-15);
    // Two balls on the axis that touch: their common point counts once.
    const double w = std::sqrt(0.5);
    const Profile beads(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4},
                        {{0, 20, 1},
                         {5, 20, w},
                         {5, 15, 1},
                         {5, 10, w},
                         {0, 10, 1},
                         {5, 10, w},
                         {5, 5, 1},
                         {5, 0, w},
                         {0, 0, 1}});
    const auto beads_reflector = make(beads);
    CHECK(beads_reflector->probe()->all_hits({{0, 0, -7}, {0, 0, 1}}, 0).size() == 3);

    const auto reflector = make(repeated);
    const auto probe = reflector->probe();
    const auto hit = probe->first_hit({{0, 0, 0}, {0, 0, 1}}, 0);
    REQUIRE(hit);
    CHECK(off(repeated, *hit, {0, 0, 10}) <= 1e-15);
    CHECK(hit->normal == Vector3(0, 0, -1));
    for (const double e : {1e-3, 1e-6, 1e-9, 1e-12}) {  // the normal on the way there has no step
      const auto near_hit = probe->first_hit({{e, 0, 0}, {0, 0, 1}}, 0);
      REQUIRE(near_hit);
      CHECK(near_hit->normal.z() == Approx(-1).epsilon(1e-3));
      CHECK(near_hit->normal.norm() == Approx(1).epsilon(1e-14));
    }
  }
}

TEST_CASE("the tip of a cone is met once, its normal in the ray's own meridian plane", "[special]") {
  const Quadric cone = Quadric::cone();
  const auto reflector = cad::make_meridian_reflector(cone.profile);
  const auto probe = reflector->probe();
  const double across = 2 / std::sqrt(5.0), up = 1 / std::sqrt(5.0);
  for (const double side : {1.0, -1.0}) {
    const auto hits = probe->all_hits({{0, 0, 8 - 20 * side}, {0, 0, side}}, 0);
    REQUIRE(hits.size() == 1);
    CHECK(hits[0].point_mm == Vector3(0, 0, 8));
    CHECK((hits[0].normal - Vector3(-side * across, 0, -side * up)).norm() <= 1e-15);
  }
  for (int power = 1; power <= 320; ++power) {
    const double e = std::pow(10.0, -power);
    INFO("off by 1e-" << power);
    const auto hits = probe->all_hits({{e, 0, 0}, {0, 0, 1}}, 0);
    REQUIRE(hits.size() == 1);
    CHECK(hits[0].point_mm.x() == Approx(e).margin(1e-15));
  }
  // Along the side: in the surface (nowhere), and beside it.
  const Vector3 along = Vector3(1, 0, -2).normalized();
  CHECK(probe->all_hits({Vector3(0, 0, 8) - 5 * Vector3(1, 0, -2), Vector3(1, 0, -2)}, 0).empty());
  CHECK(probe->all_hits({{0, 0, 8.5}, along}, 0).empty());
  CHECK(probe->all_hits({{0, 0, 7.5}, -along}, 0).size() == 1);  // across the inside to the far wall
  CHECK(probe->all_hits({{0, 0, 7.5}, along}, 0).empty());
}

TEST_CASE("horizontal and nearly horizontal rays meet the paraboloid twice", "[special]") {
  const Quadric q = Quadric::paraboloid();
  const auto reflector = cad::make_meridian_reflector(q.profile);
  const auto probe = reflector->probe();
  std::vector<double> slopes{0};
  for (int power = 1; power <= 320; ++power)
    for (const double side : {1.0, -1.0}) slopes.push_back(side * std::pow(10.0, -power));
  for (const double slope : slopes)
    for (const double y : {0.0, 1e-9, 0.3, 5.0, 7.0})
      for (const double z : {6.0, 7.5, 9.9}) {
        const Vector3 direction = Vector3(1, 0, slope).normalized();
        const Ray ray{Vector3(0, y, z) - 15 * direction, direction};
        const auto hits = probe->all_hits(ray, 0);
        const TrueHits truth = true_hits(q, ray);
        INFO("slope " << slope << " y " << y << " z " << z);
        if (truth.doubtful) continue;
        REQUIRE(hits.size() == truth.distances.size());
        for (std::size_t i = 0; i < hits.size(); ++i) {
          CHECK(static_cast<double>(std::abs(hits[i].distance_mm - truth.distances[i])) <=
                1e-12 * q.profile.diagonal_mm());
          CHECK(backward_error(q.profile, ray, hits[i]) <= 1e-14 * q.profile.diagonal_mm());
        }
      }
}

TEST_CASE("horizontal rays at the vertex, in a flat part, and touching a circle", "[special]") {
  // In the vertex' own plane: a touch at the vertex, nothing beside it.
  auto hits = meridian_hits(paraboloid, {{-20, 0, 10}, {1, 0, 0}});
  REQUIRE(hits.size() == 1);
  CHECK(off(paraboloid, hits[0], {0, 0, 10}) <= 1e-15);
  CHECK(hits[0].normal.norm() == Approx(1));
  CHECK(meridian_hits(paraboloid, {{-20, 0.001, 10}, {1, 0, 0}}).empty());
  // A cylinder: touched at (0, 3), met twice just inside, missed just outside.
  const Profile cylinder = Quadric::cylinder().profile;
  hits = meridian_hits(cylinder, {{-20, 3, 5}, {1, 0, 0}});
  REQUIRE(hits.size() == 1);
  CHECK(off(cylinder, hits[0], {0, 3, 5}) <= 1e-15);
  CHECK(meridian_hits(cylinder, {{-20, std::nextafter(3.0, 4.0), 5}, {1, 0, 0}}).empty());
  CHECK(meridian_hits(cylinder, {{-20, std::nextafter(3.0, 0.0), 5}, {1, 0, 0}}).size() == 2);
  // Touched by a rising ray, too.
  const Vector3 rising = Vector3(3, 0, 4) / 5;
  hits = meridian_hits(cylinder, {Vector3(0, 3, 6) - 5 * rising, rising});
  REQUIRE(hits.size() == 1);
  CHECK(off(cylinder, hits[0], {0, 3, 6}) <= 1e-15);
  // A flat ring: crossed once from below; a ray in it meets it nowhere.
  const Profile ring = Profile::bezier({{2, 4, 1}, {9, 4, 1}});
  CHECK(meridian_hits(ring, {{5, 0, 0}, {0, 0, 1}}).size() == 1);
  CHECK(meridian_hits(ring, {{1, 0, 0}, {0, 0, 1}}).empty());
  CHECK(meridian_hits(ring, {{-20, 0, 4}, {1, 0, 0}}).empty());
  CHECK(meridian_hits(ring, {{-20, 0, 3}, Vector3(10, 0, 1).normalized()}).size() == 0);
  CHECK(meridian_hits(ring, {{-20, 0, 3}, Vector3(14, 0, 1).normalized()}).size() == 1);
}

TEST_CASE("a ray along a cylinder's side meets it nowhere", "[special]") {
  const Profile cylinder = Quadric::cylinder().profile;
  for (const double r : {3.0, std::nextafter(3.0, 4.0), std::nextafter(3.0, 0.0)})
    CHECK(meridian_hits(cylinder, {{r, 0, 0}, {0, 0, 1}}).empty());
}

TEST_CASE("the rim belongs to the mirror, what is beyond does not", "[special]") {
  for (const double side : {1.0, -1.0}) {
    const auto hits = meridian_hits(paraboloid, {{10, 0, 5 - 20 * side}, {0, 0, side}});
    REQUIRE(hits.size() == 1);
    CHECK(off(paraboloid, hits[0], {10, 0, 5}) <= 1e-16);
    CHECK(hits[0].parameter == 1);
    CHECK(meridian_hits(paraboloid, {{std::nextafter(10.0, 11.0), 0, 5 - 20 * side}, {0, 0, side}}).empty());
    CHECK(meridian_hits(paraboloid, {{0, std::nextafter(10.0, 0.0), 5 - 20 * side}, {0, 0, side}}).size() ==
          1);
  }
  // The same with the generatrix drawn from the rim to the vertex, and at both ends of a tube.
  const Profile reversed = Profile::bezier({{10, 5, 1}, {5, 10, 1}, {0, 10, 1}});
  CHECK(meridian_hits(reversed, {{10, 0, -5}, {0, 0, 1}}).size() == 1);
  const Profile cylinder = Quadric::cylinder().profile;
  for (const double z : {2.0, 12.0}) CHECK(meridian_hits(cylinder, {{-20, 0, z}, {1, 0, 0}}).size() == 2);
}

TEST_CASE("a ray through a knot meets the surface there once", "[special]") {
  const Profile kinked(1, {0, 0, 1, 2, 3, 3}, {{0, 10, 1}, {4, 9, 2}, {7, 6, 1}, {9, 1, 3}});
  const Profile smooth(2, {0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1},
                       {{0, 10, 1}, {2, 10, 1}, {4, 9, 2}, {6, 8, 1}, {8, 5, 1}, {9, 1, 1}});
  for (const Profile& profile : {kinked, smooth, ball, paraboloid}) {
    const auto reflector = cad::make_meridian_reflector(profile);
    const auto probe = reflector->probe();
    std::vector<double> places;
    for (const RationalSpan& span : profile.spans()) {
      places.push_back(0.5 * (span.first + span.last));  // where the engine cuts spans in two
      if (span.last != profile.last_parameter()) places.push_back(span.last);
    }
    for (const double u : places)
      for (std::uint64_t i = 0; i < 2000; ++i) {
        RandomStream random(4, Purpose::test, i);
        const double phi = i % 4 == 0 ? 0 : 2 * pi * random.uniform();
        const Vector3 target = surface_point(profile, u, phi);
        const Vector3 origin(0.5 * random.uniform(), 0.5 * random.uniform(), 5 + random.uniform());
        const Ray ray{origin, (target - origin).normalized()};
        const auto hits = probe->all_hits(ray, 0);
        std::size_t there = 0;
        for (const Hit& hit : hits) there += off(profile, hit, target) < 1e-12;
        INFO("u " << u << " ray " << i);
        REQUIRE(there == 1);
        if (i % 4 == 0) {  // straight up and straight across, exact numbers
          const double r = target.x();
          CHECK(probe->all_hits({{r, 0, -20}, {0, 0, 1}}, 0).size() ==
                probe->all_hits({{0, -r, -20}, {0, 0, 1}}, 0).size());
        }
      }
  }
}

TEST_CASE("nearly tangent rays are decided as the closed form decides", "[special]") {
  std::size_t decided = 0;
  std::uint64_t exact = 0;
  for (const Quadric& q : {Quadric::paraboloid(), Quadric::cylinder()}) {  // poles without rounding
    const auto reflector = cad::make_meridian_reflector(q.profile);
    const auto probe = reflector->probe();
    for (int power = 1; power <= 17; ++power)
      for (std::uint64_t i = 0; i < 1000; ++i) {
        RandomStream random(12, Purpose::test, i);
        const double u = 0.05 + 0.9 * random.uniform(), phi = 2 * pi * random.uniform();
        const double turn = 2 * pi * random.uniform(), away = random.uniform();
        const MeridianPoint p = q.profile.at(u);
        const Vector3 outwards = Vector3(-p.dz * std::cos(phi), -p.dz * std::sin(phi), p.dr).normalized();
        const Vector3 across(-std::sin(phi), std::cos(phi), 0);
        const Vector3 tangent = std::cos(turn) * across + std::sin(turn) * across.cross(outwards);
        const double side = i % 2 == 0 ? 1 : -1;
        const Vector3 aside = side * std::pow(10.0, -power) * outwards;
        const Ray ray{surface_point(q.profile, u, phi) + aside - 20 * away * tangent, tangent};
        const TrueHits truth = true_hits(q, ray, 64 * 0x1p-64L);
        if (truth.doubtful) continue;
        ++decided;
        const auto hits = probe->all_hits(ray, 0);
        INFO(q.name << " 1e-" << power << " ray " << i);
        REQUIRE(hits.size() == truth.distances.size());
        for (const Hit& hit : hits)
          CHECK(backward_error(q.profile, ray, hit) <= 1e-13 * q.profile.diagonal_mm());
      }
    exact += dynamic_cast<const cad::MeridianProbe&>(*probe).counts().exact;
  }
  CHECK(decided > 30000);
  CHECK(exact > 1000);  // the 113-bit path is what decides here
}

TEST_CASE("a closed generatrix has no gap and no double hit where it closes", "[special]") {
  const double w = std::sqrt(0.5);
  const Profile torus(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4},
                      {{12, 0, 1},
                       {12, 2, w},
                       {10, 2, 1},
                       {8, 2, w},
                       {8, 0, 1},
                       {8, -2, w},
                       {10, -2, 1},
                       {12, -2, w},
                       {12, 0, 1}});
  const auto reflector = cad::make_meridian_reflector(torus);
  const auto probe = reflector->probe();
  for (const double u : {0.0, 1.0, 2.0, 3.0})
    for (std::uint64_t i = 0; i < 3000; ++i) {
      RandomStream random(13, Purpose::test, i);
      const double phi = i % 4 == 0 ? 0 : 2 * pi * random.uniform();
      const Vector3 target = surface_point(torus, u, phi);
      const Vector3 origin = 30 * random_direction(random);
      const auto hits = probe->all_hits({origin, (target - origin).normalized()}, 0);
      INFO("u " << u << " ray " << i);
      CHECK((hits.size() == 2 || hits.size() == 4));
      std::size_t there = 0;
      // A ray nearly along the surface there may miss the target by the square root of a rounding.
      const MeridianPoint p = torus.at(u);
      const Vector3 normal = Vector3(p.dz * std::cos(phi), p.dz * std::sin(phi), -p.dr).normalized();
      if (std::abs(normal.dot((target - origin).normalized())) < 1e-3) continue;
      for (const Hit& hit : hits) there += off(torus, hit, target) < 1e-12;
      CHECK(there == 1);
    }
  CHECK(probe->all_hits({{-30, 0, 0}, {1, 0, 0}}, 0).size() == 4);
  CHECK(probe->all_hits({{10, 0, -30}, {0, 0, 1}}, 0).size() == 2);
}

TEST_CASE("starts on, inside and beyond the surface", "[special]") {
  const auto reflector = cad::make_meridian_reflector(paraboloid);
  const auto probe = reflector->probe();
  const double lift = Tolerance::for_scale(paraboloid.diagonal_mm()).lift_mm;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    RandomStream random(5, Purpose::test, i);
    const Vector3 start = random_surface_point(paraboloid, random);
    const Vector3 inward(-start.x(), -start.y(), -10);
    Vector3 direction = random_direction(random);
    if (std::abs(direction.dot(inward.normalized())) < 1e-3) continue;
    if (direction.dot(inward) > 0) direction = -direction;
    // Outwards nothing is met again; the start itself is not counted. Backwards the inside may be met.
    CHECK_FALSE(probe->first_hit({start, direction}, lift));
    const auto all = probe->all_hits({start - 50 * direction, direction}, 0);
    REQUIRE(!all.empty());
    CHECK(all.back().distance_mm == Approx(50).epsilon(1e-11));
    CHECK(probe->all_hits({start - 50 * direction, direction}, 50 + lift).empty());
  }
  CHECK(probe->first_hit({{0, 0, 5}, {0, 0, 1}}, 0));         // inside
  CHECK_FALSE(probe->first_hit({{0, 0, 11}, {0, 0, 1}}, 0));  // beyond
  CHECK(probe->blocks({0, 0, 5}, {0, 0, 15}, lift));
  CHECK_FALSE(probe->blocks({0, 0, 5}, {0, 0, 10}, lift));
  CHECK_FALSE(probe->blocks({0, 0, 0}, {3, 3, 5}, lift));
}

TEST_CASE("from a million part sizes away the hit is that of the ray as given", "[special]") {
  const Quadric q = Quadric::paraboloid();
  const auto reflector = cad::make_meridian_reflector(q.profile);
  const auto probe = reflector->probe();
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const Ray near = random_ray(RayClass::from_focus, q.profile, q.focus, 8, i);
    const Ray ray{near.origin_mm - 1e6 * q.profile.diagonal_mm() * near.direction, near.direction};
    const auto hits = probe->all_hits(ray, 0);
    const TrueHits truth = true_hits(q, ray);
    if (truth.doubtful) continue;
    REQUIRE(hits.size() == truth.distances.size());
    for (std::size_t k = 0; k < hits.size(); ++k) {
      if (std::abs(hits[k].normal.dot(ray.direction)) < 0.1) continue;
      // The distance has the rounding of its own size; the point has not.
      const Wide t = truth.distances[k];
      const double x = static_cast<double>(ray.origin_mm.x() + t * ray.direction.x());
      const double y = static_cast<double>(ray.origin_mm.y() + t * ray.direction.y());
      const double z = static_cast<double>(ray.origin_mm.z() + t * ray.direction.z());
      CHECK(off(q.profile, hits[k], {x, y, z}) <= 1e-12);
    }
  }
}

TEST_CASE("weights over sixteen decades", "[special]") {
  for (const double weight : {1e-8, 1e-4, 1e4, 1e8}) {
    const Profile profile = Profile::bezier({{0, 10, 1}, {5, 10, weight}, {10, 5, 1}});
    const Profile uneven(
        3, Profile::uniform_knots(3, 6),
        {{0, 10, 1e-8}, {3, 10, weight}, {6, 9, 1e8}, {8, 7, 1}, {9, 4, 1e8}, {10, 1, 1e-8}});
    for (const Profile& each : {profile, uneven}) {
      const auto reflector = cad::make_meridian_reflector(each);
      const auto probe = reflector->probe();
      for (std::uint64_t i = 0; i < 3000; ++i) {
        const Ray ray = random_ray(RayClass::from_focus, each, {0, 0, 2}, 6, i);
        const auto hit = probe->first_hit(ray, 0);
        INFO("weight " << weight << " ray " << i);
        REQUIRE(hit);
        CHECK(backward_error(each, ray, *hit) <= 1e-13 * each.diagonal_mm());
      }
    }
  }
}

TEST_CASE("rays that are no rays meet nothing", "[special]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const bool reference : {false, true}) {
    const auto reflector =
        reference ? cad::make_occt_reflector(paraboloid) : cad::make_meridian_reflector(paraboloid);
    const auto probe = reflector->probe();
    for (const double bad : {nan, infinity, -infinity}) {
      CHECK_FALSE(probe->first_hit({{bad, 0, 0}, {0, 0, 1}}, 0));
      CHECK_FALSE(probe->first_hit({{0, 0, bad}, {0, 0, 1}}, 0));
      CHECK_FALSE(probe->first_hit({{0, 0, 0}, {0, bad, 1}}, 0));
      CHECK_FALSE(probe->first_hit({{0, 0, 0}, {0, 0, bad}}, 0));
    }
    CHECK_FALSE(probe->first_hit({{0, 0, 0}, {0, 0, 0}}, 0));
  }
}
