#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cad/engines.h"
#include "support/cad/quadric.h"
#include "support/cad/rays.h"

using namespace catoptric;
using namespace catoptric::test;

namespace {

struct Tally {
  std::size_t rays = 0, hits = 0, lost = 0, invented = 0, doubtful = 0, tangent = 0;
  double forward = 0;  ///< largest error of a distance, hits at less than `steep` aside, over the part's size
  double backward = 0;  ///< largest distance of a hit from its ray or the surface, over the part's size
  double normal = 0;    ///< largest error of a normal, rad
};

/// Cosine of incidence below which the distance is ill-conditioned (its error is the surface's over the
/// cosine) and only the backward error tells right from wrong.
constexpr double steep = 0.01;

void judge(const Quadric& q, const Ray& ray, const TrueHits& truth, std::span<const Hit> hits, Tally& tally) {
  const double size = q.profile.diagonal_mm();
  ++tally.rays;
  tally.hits += hits.size();
  if (truth.doubtful) {
    ++tally.doubtful;
  } else if (hits.size() != truth.distances.size()) {
    tally.lost += truth.distances.size() > hits.size();
    tally.invented += truth.distances.size() < hits.size();
  }
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    tally.backward = std::max(tally.backward, backward_error(q.profile, ray, hit) / size);
    // The gradient of x^2 + y^2 - r^2(z).
    const double z = hit.point_mm.z();
    const double slope = static_cast<double>(q.c1 + 2 * q.c2 * z);
    const Vector3 gradient(2 * hit.point_mm.x(), 2 * hit.point_mm.y(), -slope);
    const Vector3 normal = gradient.normalized() * (gradient.dot(ray.direction) > 0 ? -1 : 1);
    if (gradient.norm() > 1e-3 * size)  // a cone's tip has none
      tally.normal =
          std::max(tally.normal, std::min((normal - hit.normal).norm(), (normal + hit.normal).norm()));
    if (std::abs(hit.normal.dot(ray.direction)) < steep)
      ++tally.tangent;
    else if (hits.size() == truth.distances.size() && !truth.doubtful)
      tally.forward =
          std::max(tally.forward, std::abs(static_cast<double>(hit.distance_mm - truth.distances[i])) / size);
  }
}

void judge_all(const Quadric& q, const Ray& ray, Probe& probe, Tally& tally) {
  judge(q, ray, true_hits(q, ray), probe.all_hits(ray, 0), tally);
}

void judge_first(const Quadric& q, const Ray& ray, const std::optional<Hit>& hit, Tally& tally) {
  TrueHits truth = true_hits(q, ray);
  while (truth.distances.size() > 1) truth.distances.pop_back();
  judge(q, ray, truth, hit ? std::span(&*hit, 1) : std::span<const Hit>(), tally);
}

void hold(const Quadric& q, RayClass which, const char* how, const Tally& tally) {
  INFO(q.name << ", class " << name(which) << ", " << how);
  fmt::print(
      "{:15} {} {:12}: {:7} rays, {:7} hits, {} lost, {} invented, {} doubtful, {} tangent; errors {:.1e} "
      "forward, {:.1e} backward, {:.1e} normal\n",
      q.name, name(which), how, tally.rays, tally.hits, tally.lost, tally.invented, tally.doubtful,
      tally.tangent, tally.forward, tally.backward, tally.normal);
  CHECK(tally.lost == 0);
  CHECK(tally.invented == 0);
  CHECK(tally.forward <= 1e-12);
  CHECK(tally.backward <= 1e-13);
  CHECK(tally.normal <= 1e-12);
  CHECK(tally.doubtful <= tally.rays / 1000);
  const bool along_the_side = q.c1 == 0 && q.c2 == 0 && which == RayClass::parallel;
  CHECK((along_the_side ? tally.hits == 0 : tally.hits > tally.rays / 10));
}

/// `count` rays of each class against each quadric: the nearest hits of all, in batches, and all hits of
/// every `stride`-th ray.
void hold_to_closed_forms(std::uint64_t count, std::uint64_t stride) {
  constexpr std::uint64_t batch = 1000;
  std::vector<Ray> rays(batch);
  std::vector<std::optional<Hit>> hits(batch);
  for (const Quadric& q : Quadric::all()) {
    const auto reflector = cad::make_meridian_reflector(q.profile);
    const auto probe = reflector->probe();
    for (const RayClass which : all_classes) {
      Tally first, all;
      for (std::uint64_t from = 0; from < count; from += batch) {
        for (std::uint64_t i = 0; i < batch; ++i)
          rays[i] = random_ray(which, q.profile, q.focus, 1, from + i);
        probe->first_hits(rays, 0, hits);
        for (std::uint64_t i = 0; i < batch; ++i) {
          judge_first(q, rays[i], hits[i], first);
          if (i % stride == 0) judge_all(q, rays[i], *probe, all);
        }
      }
      hold(q, which, "nearest hits", first);
      hold(q, which, "all hits", all);
    }
  }
}

}  // namespace

TEST_CASE("meridian agrees with the closed forms of five quadrics and loses no ray", "[meridian][long]") {
  hold_to_closed_forms(100'000, 1);
}

TEST_CASE("the same with a hundred million rays", "[meridian][.long]") {
  hold_to_closed_forms(5'000'000, 10);
}
