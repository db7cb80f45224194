#pragma once

#include <Eigen/Core>
#include <cmath>

#include "base/random_stream.h"
#include "base/ray.h"
#include "base/units.h"
#include "sim/material.h"

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

/// What has become of a photon at a surface.
struct Scattered {
  Interaction interaction;
  Vector3 direction;  ///< in which it goes on, unit
};

/// Lets chance decide what a surface does with a photon that meets it.
/// @in    unit vectors; the normal may look to either side
/// @out   the numbers taken from `chance` depend on the arguments alone: none where nothing is to be decided,
///        one for the lobe, two more for a diffuse or glossy direction, in this order
Scattered scatter(const Material& material, Roulette roulette, const Vector3& incoming, const Vector3& normal,
                  RandomStream& chance);
/// The same with a choice of the directions along the surface that azimuths are counted from.
/// @in    frame: columns two directions along the surface, normal
Scattered scatter(const Material& material, Roulette roulette, const Vector3& incoming,
                  const Eigen::Matrix3d& frame, RandomStream& chance);

/// Radiance that a surface sends on over the irradiance it gets from a direction, 1/sr, without what is
/// mirrored by a smooth surface or goes straight through.
/// @in    directions of travel, unit; the normal may look to either side
/// @out   the same for light that goes the other way: bsdf(m, -out, -in)
double bsdf(const Material& material, const Vector3& in, const Vector3& out, const Vector3& normal);

}  // namespace catoptric::sim
