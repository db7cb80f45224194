#include "rayfiles/detail/ray_fault.h"

#include <cmath>

#include "rayfiles/ray_check.h"

namespace catoptric::rayfiles::detail {

std::optional<RayFault> fault_of(const SourceRay& ray) {
  if (!ray.position_mm.allFinite()) return RayFault::position_not_finite;
  if (!ray.direction.allFinite()) return RayFault::direction_not_finite;
  const double length = ray.direction.norm();
  if (length == 0) return RayFault::no_direction;
  if (std::abs(length - 1) > direction_length_tolerance) return RayFault::direction_not_unit;
  if (!std::isfinite(ray.flux)) return RayFault::flux_not_finite;
  if (ray.flux < 0) return RayFault::negative_flux;
  return std::nullopt;
}

ErrorParts words(RayFault fault) {
  const char* const hint = "export the file anew";
  switch (fault) {
    case RayFault::position_not_finite:
      return {"a start point is not finite", "", "positions are finite numbers", hint};
    case RayFault::direction_not_finite:
      return {"a direction is not finite", "", "directions are finite numbers", hint};
    case RayFault::no_direction:
      return {"a direction has no length", "", "directions have length 1", hint};
    case RayFault::direction_not_unit:
      return {"a direction is far from unit length", "", "directions have length 1, to 0.005", hint};
    case RayFault::flux_not_finite:
      return {"a flux is not finite", "", "fluxes are finite numbers", hint};
    case RayFault::negative_flux:
      return {"a flux is negative", "", "fluxes are 0 or more", hint};
  }
  return {};
}

RayField field_of(RayFault fault) {
  switch (fault) {
    case RayFault::position_not_finite:
      return RayField::position;
    case RayFault::direction_not_finite:
    case RayFault::no_direction:
    case RayFault::direction_not_unit:
      return RayField::direction;
    case RayFault::flux_not_finite:
    case RayFault::negative_flux:
      break;
  }
  return RayField::flux;
}

}  // namespace catoptric::rayfiles::detail
