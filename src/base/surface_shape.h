#pragma once

#include <optional>

#include "base/ray.h"

namespace catoptric {

/// Where a ray meets a surface other than the mirror.
struct Meeting {
  double distance_mm;  ///< along the ray, from its origin
  Vector3 normal;      ///< unit; it looks to the surface's front, whichever side the ray comes from
};

/// A surface that light may meet besides the mirror. Safe to share between threads.
class SurfaceShape {
 public:
  virtual ~SurfaceShape() = default;

  /// The nearest meeting ahead, no farther than `reach_mm`.
  /// @in    starts_here: the ray starts where it met this surface before, and does not meet it there again
  virtual std::optional<Meeting> meet(const Ray& ray, bool starts_here, double reach_mm) const = 0;
};

}  // namespace catoptric
