#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <thread>

#include "base/errors.h"
#include "base/tolerance.h"
#include "cad/detail/generatrix_facets.h"
#include "cad/engines.h"
#include "support/cad/quadric.h"
#include "support/cad/rays.h"
#include "support/cad/sample_profiles.h"

using namespace catoptric;
using namespace catoptric::test;

namespace {

/// What mesh answers to rays that meridian decides.
struct Comparison {
  std::size_t rays = 0, hits = 0;
  std::size_t lost = 0;      ///< no hit, or a later one
  std::size_t invented = 0;  ///< a hit, or an earlier one, where there is none
  double steepest_lost = 0;  ///< cosine of incidence of the lost hits, the greatest
  double point = 0;          ///< largest distance of the hits, across the ray or along, over the part's size
  double normal = 0;  ///< largest angle of the normals, times the distance from the axis over that size
};

/// Hits of rays steeper than this are compared: a grazing one has the error of the surface over the cosine.
constexpr double steep = 0.01;

void compare(const Profile& profile, Probe& truth, Probe& mesh, const Ray& ray, Comparison& sum) {
  const auto expected = truth.first_hit(ray, 0), got = mesh.first_hit(ray, 0);
  const double size = profile.diagonal_mm();
  ++sum.rays;
  sum.hits += expected.has_value();
  if (!expected && !got) return;
  constexpr double apart = 1e-6;
  const double ahead = !got        ? HUGE_VAL
                       : !expected ? -HUGE_VAL
                                   : (got->distance_mm - expected->distance_mm) / size;
  const double cosine = expected ? std::abs(expected->normal.dot(ray.direction)) : 0;
  if (ahead < -apart) ++sum.invented;
  if (ahead > apart) {
    ++sum.lost;
    sum.steepest_lost = std::max(sum.steepest_lost, cosine);
  }
  if (std::abs(ahead) > apart || cosine < steep) return;
  sum.point = std::max(sum.point, (got->point_mm - expected->point_mm).norm() / size);
  // Near a cone's tip the normal turns with the point.
  const double distance = expected->point_mm.head<2>().norm() / size;
  sum.normal = std::max(sum.normal, distance * (got->normal - expected->normal).norm());
}

Comparison compare(const Profile& profile, const Vector3& focus, const cad::MeshOptions& options,
                   RayClass which, std::uint64_t count) {
  const auto meridian = cad::make_meridian_reflector(profile);
  const auto reflector = cad::make_mesh_reflector(profile, options);
  const auto truth = meridian->probe(), mesh = reflector->probe();
  Comparison sum;
  for (std::uint64_t i = 0; i < count; ++i)
    compare(profile, *truth, *mesh, random_ray(which, profile, focus, 31, i), sum);
  return sum;
}

cad::MeshOptions chord(double relative) {
  cad::MeshOptions options;
  options.chord_error = relative;
  return options;
}

cad::MeshOptions unrefined(double relative) {
  cad::MeshOptions options = chord(relative);
  options.newton_tolerance = 1;
  return options;
}

bool same_bits(const std::optional<Hit>& a, const std::optional<Hit>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->distance_mm == b->distance_mm && a->point_mm == b->point_mm && a->normal == b->normal &&
                a->parameter == b->parameter);
}

/// A tube of radius 2 bent round at radius 10.
Profile torus() {
  const double w = std::sqrt(0.5);
  return Profile(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4},
                 {{12, 0, 1},
                  {12, 2, w},
                  {10, 2, 1},
                  {8, 2, w},
                  {8, 0, 1},
                  {8, -2, w},
                  {10, -2, 1},
                  {12, -2, w},
                  {12, 0, 1}});
}

/// A paraboloid with a hole and a wall of the given thickness: span 0 inside, span 2 outside, closed by rims.
Profile walled_bowl(double wall_mm) {
  const double w = wall_mm;
  return Profile(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4},
                 {{1, 9.95, 1},
                  {5.5, 9.5, 1},
                  {10, 5, 1},
                  {10, 5 + w / 2, 1},
                  {10, 5 + w, 1},
                  {5.5, 9.5 + w, 1},
                  {1, 9.95 + w, 1},
                  {1, 9.95 + w / 2, 1},
                  {1, 9.95, 1}});
}

}  // namespace

TEST_CASE("mesh finds meridian's hits, and what it loses grazes the surface within the chord error",
          "[mesh][long]") {
  constexpr std::uint64_t count = 20000;
  for (const Quadric& q : Quadric::all())
    for (const double relative : {1e-3, 1e-4}) {
      for (const RayClass which : all_classes) {
        const Comparison got = compare(q.profile, q.focus, chord(relative), which, count);
        fmt::print("{:15} chord {:.0e} {}: {} hits, {} lost (cosine {:.3f}); points {:.1e}, normals {:.1e}\n",
                   q.name, relative, name(which), got.hits, got.lost, got.steepest_lost, got.point,
                   got.normal);
        INFO(q.name << " chord " << relative << " class " << name(which));
        CHECK(got.invented == 0);
        CHECK(got.point <= 1e-12);
        CHECK(got.normal <= 1e-12);
        // A ray that dips into a curved surface by d has an incidence whose cosine is sqrt(2 d / radius). The
        // least radius here is a fifth of the part; facets lie within the chord error on both sides.
        CHECK(got.steepest_lost <= std::sqrt(2 * 2 * relative / 0.2));
        if (which == RayClass::from_focus || which == RayClass::isotropic) CHECK(got.lost == 0);
      }
    }
}

TEST_CASE("mesh: rays from the focus, and parallel ones up to the rim, are all found", "[mesh]") {
  const Quadric q = Quadric::paraboloid();
  for (const RayClass which : {RayClass::from_focus, RayClass::isotropic, RayClass::parallel})
    CHECK(compare(q.profile, q.focus, chord(1e-4), which, 100000).lost == 0);
}

TEST_CASE("mesh without refinement is off by no more than the chord error", "[mesh]") {
  const Quadric q = Quadric::paraboloid();
  const double size = q.profile.diagonal_mm();
  const auto meridian = cad::make_meridian_reflector(q.profile);
  const auto truth = meridian->probe();
  for (const double relative : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const auto reflector = cad::make_mesh_reflector(q.profile, unrefined(relative));
    const auto mesh = reflector->probe();
    double off = 0, angle = 0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      const Ray ray = random_ray(RayClass::from_focus, q.profile, q.focus, 32, i);
      const auto expected = truth->first_hit(ray, 0), got = mesh->first_hit(ray, 0);
      if (!got || expected->parameter > 0.99) continue;  // beyond a facet's rim there is no hit
      const double cosine = std::abs(expected->normal.dot(ray.direction));
      off = std::max(off, std::abs(got->distance_mm - expected->distance_mm) * cosine / size);
      angle = std::max(angle, (got->normal - expected->normal).norm());
      CHECK(backward_error(q.profile, ray, *got) <= 2 * relative * size / cosine);
    }
    fmt::print("chord {:.0e}: unrefined hits off by {:.2e}, normals by {:.1e}\n", relative, off, angle);
    CHECK(off <= relative);
    CHECK(off >= 0.1 * relative);  // or more triangles are spent than asked for
  }
}

TEST_CASE("mesh: a looser Newton tolerance leaves the error it allows", "[mesh]") {
  const Quadric q = Quadric::paraboloid();
  const auto meridian = cad::make_meridian_reflector(q.profile);
  const auto truth = meridian->probe();
  for (const double tolerance : {1e-6, 1e-9}) {
    cad::MeshOptions options = chord(1e-3);
    options.newton_tolerance = tolerance;
    const auto reflector = cad::make_mesh_reflector(q.profile, options);
    const auto mesh = reflector->probe();
    double off = 0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      const Ray ray = random_ray(RayClass::from_focus, q.profile, q.focus, 33, i);
      const auto expected = truth->first_hit(ray, 0), got = mesh->first_hit(ray, 0);
      REQUIRE(got);
      const double cosine = std::abs(expected->normal.dot(ray.direction));
      off = std::max(off, (got->point_mm - expected->point_mm).norm() * cosine / q.profile.diagonal_mm());
    }
    CHECK(off <= 2 * tolerance);
    CHECK(off > 1e-14);  // it did stop early
  }
}

TEST_CASE("mesh: all hits, each once, also through corners and edges of facets", "[mesh]") {
  const Quadric q = Quadric::paraboloid();
  const cad::meridian::SpanTable table(q.profile);
  const double size = q.profile.diagonal_mm();
  const cad::detail::GeneratrixFacets facets(table, 1e-3 * size);
  const auto meridian = cad::make_meridian_reflector(q.profile);
  const auto reflector = cad::make_mesh_reflector(q.profile, chord(1e-3));
  const auto truth = meridian->probe(), mesh = reflector->probe();
  const auto place = [&](std::uint32_t vertex) {
    const auto& v = facets.mesh.vertices[vertex];
    return Vector3(Vector3(v[0], v[1], v[2]) / facets.scale + Vector3(0, 0, table.centre_z));
  };
  std::size_t several = 0, lost = 0;
  for (std::size_t i = 0; i < facets.mesh.triangles.size(); ++i) {
    const auto& corners = facets.mesh.triangles[i];
    RandomStream random(34, Purpose::test, i);
    const Vector3 from = q.focus + 2 * random_direction(random);
    const Vector3 far = q.focus + 60 * random_direction(random);
    const Vector3 edge = 0.3 * place(corners[0]) + 0.7 * place(corners[1 + i % 2]);
    for (const Vector3& target : {place(corners[0]), edge})
      for (const Vector3& origin : {from, far}) {
        const Ray ray{origin, (target - origin).normalized()};
        const auto expected = truth->all_hits(ray, 0), got = mesh->all_hits(ray, 0);
        several += expected.size() > 1;
        if (!expected.empty() && std::abs(expected[0].normal.dot(ray.direction)) < 0.1) continue;
        INFO("triangle " << i);
        if (got.size() < expected.size()) {  // Embree is watertight at edges, not quite at corners
          CHECK(target != edge);
          ++lost;
          continue;
        }
        REQUIRE(got.size() == expected.size());
        for (std::size_t k = 0; k < got.size(); ++k)
          CHECK((got[k].point_mm - expected[k].point_mm).norm() <= 1e-12 * size);
      }
  }
  CHECK(several > 100);
  fmt::print("through corners: {} of {} rays lost\n", lost, 2 * facets.mesh.triangles.size());
  CHECK(lost <= facets.mesh.triangles.size() / 100);
}

TEST_CASE("mesh: the vertex, where all facets of the fan meet, is hit once and head-on", "[mesh]") {
  const Profile profile = Quadric::paraboloid().profile;
  const auto reflector = cad::make_mesh_reflector(profile, {});
  const auto mesh = reflector->probe();
  for (const double side : {1.0, -1.0})
    for (std::uint64_t i = 0; i < 1000; ++i) {
      const double z = side > 0 ? 10 - std::pow(10.0, 2 - 0.01 * static_cast<double>(i))
                                : 10.5 + 0.1 * static_cast<double>(i);
      const auto hits = mesh->all_hits({{0, 0, z}, {0, 0, side}}, 0);
      INFO("from " << z);
      REQUIRE(hits.size() == 1);
      CHECK(hits[0].point_mm == Vector3(0, 0, 10));
      CHECK(hits[0].normal == Vector3(0, 0, -side));
      CHECK(hits[0].parameter == 0);
      RandomStream random(41, Purpose::test, i);
      Vector3 direction = random_direction(random);
      direction.z() = side * std::abs(direction.z());
      if (std::abs(direction.z()) < 0.1) continue;
      const auto tilted = mesh->all_hits({Vector3(0, 0, 10) - 3 * direction, direction}, 2);
      REQUIRE(!tilted.empty());
      CHECK((tilted[0].point_mm - Vector3(0, 0, 10)).norm() <= 1e-12 * profile.diagonal_mm());
    }
}

TEST_CASE("mesh: a closed generatrix has no gap and no double hit", "[mesh]") {
  const Profile profile = torus();
  const auto meridian = cad::make_meridian_reflector(profile);
  const auto reflector = cad::make_mesh_reflector(profile, chord(1e-4));
  const auto truth = meridian->probe(), mesh = reflector->probe();
  std::size_t four = 0, differ = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    RandomStream random(35, Purpose::test, i);
    const double u =
        i % 2 == 0 ? static_cast<double>(i % 8) / 2 : 4 * random.uniform();  // half at the joints
    const Vector3 target = surface_point(profile, u, i % 3 == 0 ? 0 : 2 * pi * random.uniform());
    const Vector3 origin = 30 * random_direction(random);
    const Ray ray{origin, (target - origin).normalized()};
    const auto expected = truth->all_hits(ray, 0), got = mesh->all_hits(ray, 0);
    four += expected.size() == 4;
    bool grazes = false;
    for (const Hit& hit : expected) grazes = grazes || std::abs(hit.normal.dot(ray.direction)) < 0.1;
    differ += got.size() != expected.size();
    if (!grazes) REQUIRE(got.size() == expected.size());
  }
  CHECK(four > 2000);
  fmt::print("torus: {} of 20000 rays with another number of hits\n", differ);
  CHECK(differ < 400);
}

TEST_CASE("mesh: of two sheets nearer than the chord error the nearer is hit", "[mesh]") {
  for (const double wall_mm : {1e-1, 1e-3, 1e-6}) {  // the chord error is 2.9e-2 mm
    const Profile profile = walled_bowl(wall_mm);
    const auto reflector = cad::make_mesh_reflector(profile, chord(1e-3));
    const auto mesh = reflector->probe();
    for (std::uint64_t i = 0; i < 5000; ++i) {
      RandomStream random(36, Purpose::test, i);
      const Vector3 inside(random.uniform() - 0.5, random.uniform() - 0.5, 5 + random.uniform());
      const Vector3 target =
          surface_point(profile, 0.02 + 0.96 * random.uniform(), 2 * pi * random.uniform());
      const Ray ray{inside, (target - inside).normalized()};
      const auto hits = mesh->all_hits(ray, 0);
      INFO("wall " << wall_mm << " ray " << i);
      REQUIRE(hits.size() == 2);
      CHECK(hits[0].parameter < 1);
      CHECK(hits[1].parameter > 2);
      CHECK(same_bits(mesh->first_hit(ray, 0), hits[0]));
    }
  }
}

TEST_CASE("mesh: reflected rays leave the facet they stand on", "[mesh]") {
  // Seen from inside a facet lies before the surface: its own start must not stop a reflected ray.
  const Profile profile = torus();
  const auto meridian = cad::make_meridian_reflector(profile);
  const auto reflector = cad::make_mesh_reflector(profile, chord(1e-3));
  const auto truth = meridian->probe(), mesh = reflector->probe();
  const double lift = Tolerance::for_scale(profile.diagonal_mm()).lift_mm;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    RandomStream random(37, Purpose::test, i);
    Ray ray{Vector3(10, 0, 0) + random_direction(random), random_direction(random)};
    for (int bounce = 0; bounce < 4; ++bounce) {
      const auto expected = truth->first_hit(ray, bounce == 0 ? 0 : lift);
      const auto got = mesh->first_hit(ray, bounce == 0 ? 0 : lift);
      REQUIRE(expected);
      if (std::abs(expected->normal.dot(ray.direction)) < 0.2) break;
      REQUIRE(got);
      CHECK((got->point_mm - expected->point_mm).norm() <= 1e-12 * profile.diagonal_mm());
      ray = {got->point_mm, ray.direction - 2 * got->normal.dot(ray.direction) * got->normal};
    }
  }
}

TEST_CASE("mesh: every degree, several spans, weights and knots at their ends", "[mesh]") {
  std::vector<Profile> profiles{multiple_knots_profile(), wild_weights_profile()};
  for (int degree = 1; degree <= 9; ++degree)
    for (const bool rational : {false, true}) profiles.push_back(wavy_profile(degree, rational));
  for (const Profile& profile : profiles)
    for (const RayClass which : {RayClass::from_focus, RayClass::isotropic, RayClass::parallel}) {
      const Comparison got = compare(profile, {0, 0, 40}, chord(1e-4), which, 3000);
      INFO("degree " << profile.degree() << " poles " << profile.points().size() << " class " << name(which));
      CHECK(got.lost <= 3);
      CHECK(got.steepest_lost <= 0.1);
      CHECK(got.invented == 0);
      CHECK(got.point <= 1e-11);
    }
}

TEST_CASE("mesh: parts from 1 um to 100 m, bit for bit alike at powers of two", "[mesh]") {
  const Quadric q = Quadric::paraboloid();
  const auto reflector = cad::make_mesh_reflector(q.profile, {});
  const auto probe = reflector->probe();
  for (const double factor : {0x1p-14, 0x1p+12, 3.5e-5, 3.5e3}) {
    std::vector<ControlPoint> points = q.profile.points();
    for (ControlPoint& point : points) {
      point.r_mm *= factor;
      point.z_mm *= factor;
    }
    const auto scaled = cad::make_mesh_reflector(Profile::bezier(points), {});
    const auto other = scaled->probe();
    const bool exactly = std::frexp(factor, std::array<int, 1>{}.data()) == 0.5;
    for (const RayClass which : all_classes)
      for (std::uint64_t i = 0; i < 1000; ++i) {
        const Ray ray = random_ray(which, q.profile, q.focus, 38, i);
        const auto a = probe->first_hit(ray, 0);
        const auto b = other->first_hit({factor * ray.origin_mm, ray.direction}, 0);
        if (exactly) {
          REQUIRE(a.has_value() == b.has_value());
          if (!a) continue;
          CHECK(a->distance_mm * factor == b->distance_mm);
          CHECK(a->parameter == b->parameter);
          CHECK(a->normal == b->normal);
        } else if (a && b && std::abs(a->normal.dot(ray.direction)) > 0.1) {
          CHECK((factor * a->point_mm - b->point_mm).norm() <= 1e-12 * factor * q.profile.diagonal_mm());
        } else if (which != RayClass::grazing) {
          CHECK(a.has_value() == b.has_value());
        }
      }
  }
}

TEST_CASE("mesh: from a million part sizes away", "[mesh]") {
  const Quadric q = Quadric::paraboloid();
  const auto meridian = cad::make_meridian_reflector(q.profile);
  const auto reflector = cad::make_mesh_reflector(q.profile, {});
  const auto truth = meridian->probe(), mesh = reflector->probe();
  Comparison sum;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const Ray near = random_ray(RayClass::from_focus, q.profile, q.focus, 39, i);
    compare(q.profile, *truth, *mesh,
            {near.origin_mm - 1e6 * q.profile.diagonal_mm() * near.direction, near.direction}, sum);
  }
  CHECK(sum.hits == 20000);
  CHECK(sum.steepest_lost <= 0.1);
  CHECK(sum.point <= 1e-11);
}

TEST_CASE("mesh: many rays at once, and probes on several threads, give a single ray's bits", "[mesh]") {
  const Profile profile = wavy_profile(4, true);
  const auto reflector = cad::make_mesh_reflector(profile, {});
  constexpr std::uint64_t count = 20000;
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i)
    rays.push_back(random_ray(all_classes[i % 4], profile, {1, 2, 30}, 40, i));
  const auto probe = reflector->probe();
  std::vector<std::optional<Hit>> single;
  for (const Ray& ray : rays) single.push_back(probe->first_hit(ray, 0));

  std::vector<std::vector<std::optional<Hit>>> together(4);
  std::vector<std::thread> threads;
  for (auto& hits : together)
    threads.emplace_back([&] {
      hits.resize(count);
      reflector->probe()->first_hits(rays, 0, hits);
    });
  for (std::thread& thread : threads) thread.join();
  // Again with triangles sorted anew: the order must be the same.
  together.emplace_back(count);
  cad::make_mesh_reflector(profile, {})->probe()->first_hits(rays, 0, together.back());
  for (const auto& hits : together)
    for (std::uint64_t i = 0; i < count; ++i) REQUIRE(same_bits(hits[i], single[i]));
}

TEST_CASE("mesh leaves the caller's arithmetic as it was", "[mesh]") {
  const volatile double tiny = std::numeric_limits<double>::min();
  const auto reflector = cad::make_mesh_reflector(Quadric::paraboloid().profile, {});
  const auto probe = reflector->probe();
  CHECK(tiny / 4 > 0);
  CHECK(probe->first_hit({{0, 0, 5}, {0, 0, 1}}, 0));
  CHECK(tiny / 4 > 0);
  CHECK(probe->all_hits({{0, 0, 5}, {0, 0, 1}}, 0).size() == 1);
  CHECK(tiny / 4 > 0);
}

TEST_CASE("mesh: rays that are no rays meet nothing, and options that are none are refused", "[mesh]") {
  const Profile profile = Quadric::paraboloid().profile;
  const auto reflector = cad::make_mesh_reflector(profile, {});
  const auto probe = reflector->probe();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, HUGE_VAL, -HUGE_VAL}) {
    CHECK_FALSE(probe->first_hit({{bad, 0, 0}, {0, 0, 1}}, 0));
    CHECK_FALSE(probe->first_hit({{0, 0, bad}, {0, 0, 1}}, 0));
    CHECK_FALSE(probe->first_hit({{0, 0, 0}, {0, bad, 1}}, 0));
    CHECK_FALSE(probe->first_hit({{0, 0, 0}, {0, 0, bad}}, 0));
  }
  CHECK_FALSE(probe->first_hit({{0, 0, 0}, {0, 0, 0}}, 0));
  for (const double bad : {nan, 0.0, -1.0, 1e-9, 1.0}) {
    CHECK_THROWS_AS(cad::make_mesh_reflector(profile, chord(bad)), InputError);
    cad::MeshOptions options;
    options.chord_error_mm = bad * profile.diagonal_mm();
    CHECK_THROWS_AS(cad::make_mesh_reflector(profile, options), InputError);
    options = {};
    options.newton_tolerance = -std::abs(bad);
    CHECK_THROWS_AS(cad::make_mesh_reflector(profile, options), InputError);
  }
}
