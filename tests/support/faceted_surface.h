#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "base/surface_shape.h"

namespace catoptric::test {

/// Facets met by asking each of them (Moeller and Trumbore 1997), in double precision.
class FacetedSurface final : public SurfaceShape {
 public:
  explicit FacetedSurface(std::shared_ptr<const Facets> facets) : facets_(std::move(facets)) {}

  std::optional<Meeting> meet(const Ray& ray, bool starts_here, double reach_mm) const override {
    std::optional<Meeting> nearest;
    const double beyond_mm = starts_here ? 1e-6 : 0;
    for (std::size_t i = 0; i < facets_->corners.size(); ++i) {
      const Vector3 &a = facets_->corner_mm(i, 0), u = facets_->corner_mm(i, 1) - a,
                    v = facets_->corner_mm(i, 2) - a, across = u.cross(v);
      const double climb = across.dot(ray.direction);
      if (climb == 0) continue;
      const Vector3 from = ray.origin_mm - a;
      const double t = -across.dot(from) / climb;
      const Vector3 at = from + t * ray.direction;
      const double square = across.squaredNorm(), p = at.cross(v).dot(across) / square,
                   q = u.cross(at).dot(across) / square;
      if (!(t > beyond_mm && t <= reach_mm && p >= 0 && q >= 0 && p + q <= 1)) continue;
      reach_mm = t;
      nearest = Meeting{t, across.normalized(), static_cast<std::uint32_t>(i)};
    }
    return nearest;
  }

  std::vector<std::vector<Vector3>> outlines() const override { return facets_->outlines(); }

 private:
  std::shared_ptr<const Facets> facets_;
};

/// A parallelogram as two facets: the front is where a, a + u, a + u + v run counterclockwise.
inline void add_parallelogram(Facets& facets, const Vector3& a, const Vector3& u, const Vector3& v) {
  const auto first = static_cast<std::uint32_t>(facets.points_mm.size());
  for (const Vector3& point : {a, Vector3(a + u), Vector3(a + u + v), Vector3(a + v)})
    facets.points_mm.push_back(point);
  facets.corners.push_back({first, first + 1, first + 2});
  facets.corners.push_back({first, first + 2, first + 3});
}

/// A sphere of 20 * 4^depth facets with their corners on it, fronts outside.
inline Facets icosphere(const Vector3& centre_mm, double radius_mm, int depth) {
  const double golden = 0.5 * (1 + std::sqrt(5.0));
  Facets facets;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-golden, golden})
      for (const Vector3& point : {Vector3(0, a, b), Vector3(a, b, 0), Vector3(b, 0, a)})
        facets.points_mm.push_back(point.normalized());
  const auto outwards = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const auto& p = facets.points_mm;
    const bool out = (p[j] - p[i]).cross(p[k] - p[i]).dot(p[i]) > 0;
    return out ? std::array{i, j, k} : std::array{i, k, j};
  };
  for (std::uint32_t i = 0; i < 12; ++i)
    for (std::uint32_t j = i + 1; j < 12; ++j)
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        const auto near = [&](std::uint32_t m, std::uint32_t n) {
          return facets.points_mm[m].dot(facets.points_mm[n]) > 0.4;
        };
        if (near(i, j) && near(j, k) && near(i, k)) facets.corners.push_back(outwards(i, j, k));
      }
  for (int level = 0; level < depth; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t m, std::uint32_t n) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(m, n), facets.points_mm.size());
      if (fresh) facets.points_mm.push_back((facets.points_mm[m] + facets.points_mm[n]).normalized());
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [i, j, k] : facets.corners) {
      const std::uint32_t a = middle(i, j), b = middle(j, k), c = middle(k, i);
      for (const auto& corners :
           {std::array{i, a, c}, std::array{a, j, b}, std::array{c, b, k}, std::array{a, b, c}})
        finer.push_back(corners);
    }
    facets.corners = std::move(finer);
  }
  for (Vector3& point : facets.points_mm) point = centre_mm + radius_mm * point;
  return facets;
}

}  // namespace catoptric::test
