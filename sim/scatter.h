#pragma once

#include <cmath>

#include "base/ray.h"
#include "base/units.h"

namespace catoptric::sim {

/// Mirror reflection; `normal` may look to either side.
/// @out unit length again, so that no error builds up over a thousand bounces
inline Vector3 reflect(const Vector3& direction, const Vector3& normal) {
  return (direction - 2 * direction.dot(normal) * normal).normalized();
}

/// A direction of diffuse reflection into the side `normal` looks to: probability in proportion to the
/// cosine with it (Lambert). `along` and `across` complete the normal to a right-angled frame.
/// @in    numbers uniform in [0, 1)
/// @from  Malley's method: a uniform point of the unit disc, lifted to the hemisphere
inline Vector3 diffuse_direction(const Vector3& along, const Vector3& across, const Vector3& normal,
                                 double first, double second) {
  const double radius = std::sqrt(first), angle = 2 * pi * second;
  return (radius * std::cos(angle) * along + radius * std::sin(angle) * across +
          std::sqrt(1 - first) * normal)
      .normalized();
}

}  // namespace catoptric::sim
