#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "cad/engines.h"
#include "cad/meridian_reflector.h"
#include "support/cad/quadric.h"
#include "support/cad/random_profile.h"
#include "support/cad/rays.h"

/// Batches against single rays, bit for bit. The code for single rays is compiled once, for the plain
/// processor; so this also holds every copy of the code for several rays, whatever processor it is for, to
/// the same bits.

using namespace catoptric;
using namespace catoptric::test;

namespace {

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const std::optional<Hit>& a, const std::optional<Hit>& b) {
  if (a.has_value() != b.has_value()) return false;
  if (!a) return true;
  bool same = same_bits(a->distance_mm, b->distance_mm) && same_bits(a->parameter, b->parameter);
  for (int i = 0; i < 3; ++i)
    same = same && same_bits(a->point_mm[i], b->point_mm[i]) && same_bits(a->normal[i], b->normal[i]);
  return same;
}

std::vector<Ray> easy_rays(const Profile& profile, std::uint64_t count) {
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i)
    rays.push_back(random_ray(all_classes[i % 4], profile, {1, 2, 0.4 * profile.z_max_mm()}, 31, i));
  return rays;
}

/// What double alone cannot decide or the solver treats apart: along the axis and the surface's normals
/// there, across it, tangents, through ends and knots, and rays that are none.
std::vector<Ray> hard_rays(const Profile& profile) {
  const double size = profile.diagonal_mm(), nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Ray> rays{{{0, 0, -size}, {0, 0, 1}},      {{0, 0, 3 * size}, {0, 0, -1}},
                        {{1e-300, 0, -size}, {0, 0, 1}}, {{nan, 0, 0}, {0, 0, 1}},
                        {{0, 0, 0}, {0, nan, 0}},        {{0, 0, 0}, {0, 0, 0}}};
  std::vector<double> places{profile.first_parameter(), profile.last_parameter()};
  for (const RationalSpan& span : profile.spans())
    for (const double share : {0.25, 0.3, 0.5, 1.0})
      places.push_back(span.first + share * (span.last - span.first));
  for (const double u : places) {
    const MeridianPoint p = profile.at(u);
    const Vector3 at(p.r_mm, 0, p.z_mm), along = Vector3(p.dr, 0, p.dz).normalized();
    const Vector3 aims[] = {{0, 0, 1},
                            {0, 0, -1},
                            {1, 0, 0},
                            {0, 1, 0},
                            along,
                            -along,
                            (along + Vector3(0, 0.5, 0)).normalized(),
                            Vector3(1, 0, 1e-18),
                            Vector3(1, 0, 1e-9),
                            Vector3(0.6, 0, 0.8),
                            Vector3(-0.48, 0.6, 0.64)};
    for (const Vector3& aim : aims)
      for (const double off : {0.0, 1e-15, 1e-9})
        rays.push_back({at - size * aim + off * Vector3(0.6, 0.8, 0), aim});
  }
  return rays;
}

std::vector<Ray> shuffled(std::vector<Ray> rays, const std::vector<Ray>& more, std::uint64_t seed) {
  rays.insert(rays.end(), more.begin(), more.end());
  std::mt19937_64 random(seed);
  for (std::size_t i = rays.size(); i > 1; --i) std::swap(rays[i - 1], rays[random() % i]);
  return rays;
}

using Hits = std::vector<std::optional<Hit>>;

Hits one_by_one(Probe& probe, const std::vector<Ray>& rays, double beyond_mm) {
  Hits hits;
  for (const Ray& ray : rays) hits.push_back(probe.first_hit(ray, beyond_mm));
  return hits;
}

/// The number of rays whose hit is another when they come `size` at a time.
std::size_t differing(Probe& probe, const std::vector<Ray>& rays, const Hits& alone, double beyond_mm,
                      std::size_t size) {
  Hits hits(rays.size());
  // What was in the answers before must not shine through.
  std::fill(hits.begin(), hits.end(), Hit{-1, {0, 0, 0}, {0, 0, 0}, -1});
  const std::span<const Ray> all(rays);
  for (std::size_t from = 0; from < rays.size(); from += size) {
    const std::size_t count = std::min(size, rays.size() - from);
    probe.first_hits(all.subspan(from, count), beyond_mm, std::span(hits).subspan(from, count));
  }
  std::size_t different = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) different += !same_bits(hits[i], alone[i]);
  return different;
}

std::vector<Profile> profiles() {
  std::vector<Profile> all;
  for (const Quadric& quadric : Quadric::all()) all.push_back(quadric.profile);
  for (int degree = 1; degree <= 9; ++degree) all.push_back(random_profile(degree, 5));
  std::vector<ControlPoint> many;  // enough spans for a tree
  for (int i = 0; i < 40; ++i)
    many.push_back({2.0 * i, 60 - 0.01 * i * i + (i * 7) % 5 * (i > 1), 1 + 0.5 * (i % 3)});
  all.emplace_back(3, Profile::uniform_knots(3, many.size()), many);
  return all;
}

}  // namespace

TEST_CASE("a ray has the same hit in any batch as alone, bit for bit", "[meridian][long]") {
  for (const Profile& profile : profiles()) {
    const auto reflector = cad::make_meridian_reflector(profile);
    const auto probe = reflector->probe();
    const std::vector<Ray> rays = shuffled(easy_rays(profile, 3000), hard_rays(profile), 1);
    INFO("degree " << profile.degree() << ", " << profile.spans().size() << " spans");
    for (const double beyond : {0.0, 0.4 * profile.diagonal_mm()}) {
      const Hits alone = one_by_one(*probe, rays, beyond);
      for (const std::size_t size : {1000, 128, 65, 64, 63})
        CHECK(differing(*probe, rays, alone, beyond, size) == 0);
    }
  }
}

TEST_CASE("the first hit is the nearest of all hits: what is passed over lies beyond it",
          "[meridian][long]") {
  for (const Profile& profile : profiles()) {
    const auto reflector = cad::make_meridian_reflector(profile);
    const auto probe = reflector->probe();
    const double size = profile.diagonal_mm();
    const std::vector<Ray> rays = shuffled(easy_rays(profile, 6000), hard_rays(profile), 2);
    std::size_t several = 0, wrong = 0;
    for (const double beyond : {0.0, 0.4 * size})
      for (const Ray& ray : rays) {
        const std::optional<Hit> first = probe->first_hit(ray, beyond);
        const std::vector<Hit> all = probe->all_hits(ray, beyond);
        several += all.size() > 1;
        wrong += first.has_value() == all.empty() ||
                 (first && !(std::abs(first->distance_mm - all.front().distance_mm) <= 1e-12 * size));
      }
    INFO("degree " << profile.degree() << ", " << profile.spans().size() << " spans");
    CHECK(wrong == 0);
    CHECK(several > rays.size() / 10);
  }
}

TEST_CASE("batches of one to seventeen rays, easy and hard ones mixed", "[meridian]") {
  const Profile paraboloid = Quadric::paraboloid().profile;
  for (const Profile& profile : {paraboloid, random_profile(4, 5)}) {
    const auto reflector = cad::make_meridian_reflector(profile);
    const auto probe = reflector->probe();
    for (std::size_t size = 1; size <= 17; ++size) {
      INFO("batches of " << size);
      const std::vector<Ray> rays = shuffled(easy_rays(profile, 1000), hard_rays(profile), size);
      CHECK(differing(*probe, rays, one_by_one(*probe, rays, 0), 0, size) == 0);
    }
    std::vector<std::optional<Hit>> none;
    probe->first_hits({}, 0, none);
  }
}

TEST_CASE("of ordinary rays nearly all are answered side by side, of hard ones few", "[meridian]") {
  for (const Quadric& quadric : {Quadric::paraboloid(), Quadric::half_ellipsoid()}) {
    const auto reflector = cad::make_meridian_reflector(quadric.profile);
    for (const RayClass which : all_classes) {
      std::vector<Ray> rays;
      for (std::uint64_t i = 0; i < 10000; ++i)
        rays.push_back(random_ray(which, quadric.profile, quadric.focus, 32, i));
      std::vector<std::optional<Hit>> hits(rays.size());
      const auto probe = reflector->probe();
      probe->first_hits(rays, 0, hits);
      const auto& counts = dynamic_cast<const cad::MeridianProbe&>(*probe).counts();
      INFO(quadric.name << ", class " << name(which));
      CHECK(counts.rays == rays.size());
      if (cad::meridian_works_side_by_side())
        CHECK(counts.side_by_side > 9500);
      else
        CHECK(counts.side_by_side == 0);
    }
    const std::vector<Ray> hard = hard_rays(quadric.profile);
    std::vector<std::optional<Hit>> hits(hard.size());
    const auto probe = reflector->probe();
    probe->first_hits(hard, 0, hits);
    const auto& counts = dynamic_cast<const cad::MeridianProbe&>(*probe).counts();
    CHECK(counts.rays == hard.size());
    CHECK(counts.side_by_side < hard.size() / 2);
    CHECK(counts.exact > hard.size() / 10);
  }
}
