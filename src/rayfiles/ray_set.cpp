#include "rayfiles/ray_set.h"

namespace catoptric::rayfiles {

SourceRay RaySet::ray(std::uint64_t i) const {
  SourceRay ray = as_stored(i);
  const double length = ray.direction.norm();
  if (length > 0) ray.direction /= length;
  return ray;
}

}  // namespace catoptric::rayfiles
