#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/ray.h"

namespace catoptric {

/// Where a ray meets a surface other than the mirror.
struct Meeting {
  double distance_mm;       ///< along the ray, from its origin
  Vector3 normal;           ///< unit; it looks to the surface's front, whichever side the ray comes from
  std::uint32_t facet = 0;  ///< of a surface that is made of facets
};

/// A surface that light may meet besides the mirror. Safe to share between threads.
class SurfaceShape {
 public:
  virtual ~SurfaceShape() = default;

  /// The nearest meeting ahead, no farther than `reach_mm`.
  /// @in    starts_here: the ray starts where it met this surface before, and does not meet it there again
  virtual std::optional<Meeting> meet(const Ray& ray, bool starts_here, double reach_mm) const = 0;

  /// Lines on it that show a person where it is, mm.
  virtual std::vector<std::vector<Vector3>> outlines() const = 0;

  /// Whether it certainly is one of revolution about the z axis, to a billionth of its size.
  virtual bool is_round() const { return false; }
};

/// Flat triangles, corners counterclockwise as seen from the front.
struct Facets {
  std::vector<Vector3> points_mm;
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< of each triangle, its points

  const Vector3& corner_mm(std::size_t facet, std::size_t corner) const {
    return points_mm[corners[facet][corner]];
  }

  /// Borders of the facets, of very many an even selection: what SurfaceShape::outlines() gives.
  std::vector<std::vector<Vector3>> outlines() const {
    constexpr std::size_t most = 600;
    std::vector<std::vector<Vector3>> lines;
    for (std::size_t facet = 0; facet < corners.size(); facet += 1 + corners.size() / most)
      lines.push_back({corner_mm(facet, 0), corner_mm(facet, 1), corner_mm(facet, 2), corner_mm(facet, 0)});
    return lines;
  }
};

}  // namespace catoptric
