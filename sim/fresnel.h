#pragma once

#include <algorithm>
#include <optional>

#include "base/ray.h"

namespace catoptric::sim {

/// Shares of light that a smooth boundary reflects, by its polarisation.
struct PolarisedReflectance {
  double across;  ///< the field swings across the plane of incidence: s
  double along;   ///< in the plane: p
  double mean() const { return std::min(1.0, 0.5 * (across + along)); }
};

/// Both of a boundary between clear media; in and out as dielectric_reflectance.
PolarisedReflectance polarised_reflectance(double cosine, double index_ratio);

/// Share of unpolarised light that a smooth boundary of two clear media reflects, the mean of both
/// polarisations.
/// @in    cosine of the incidence, in [0, 1]; index_ratio: refractive index beyond the boundary over the one
///        before it, positive and finite
/// @out   in [0, 1]; 1 at total reflection and at grazing incidence, exactly 0 where the indices are equal
/// @error some roundings of the result, however near the indices or the incidence to grazing; at the critical
///        angle as the cosine's own rounding allows
/// @from  Fresnel; Born & Wolf, Principles of Optics, section 1.5.3
double dielectric_reflectance(double cosine, double index_ratio);

/// The same for a metal in a clear medium.
/// @in    cosine of the incidence, in [0, 1]; index n > 0 and extinction k >= 0 of the metal's n + i k over
///        the index before it, finite
/// @from  Born & Wolf, Principles of Optics, section 14.2
double conductor_reflectance(double cosine, double index, double extinction);

/// The direction into which a boundary bends a ray.
/// @in    unit vectors; the normal may look to either side; index_ratio as dielectric_reflectance
/// @out   unit length; nothing at total reflection
/// @from  Snell
std::optional<Vector3> refract(const Vector3& direction, const Vector3& normal, double index_ratio);

}  // namespace catoptric::sim
