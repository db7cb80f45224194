#pragma once

#include <optional>

#include "base/errors.h"
#include "rayfiles/ray_set.h"

namespace catoptric::rayfiles::detail {

/// What may be wrong with a ray by itself.
enum class RayFault {
  position_not_finite,
  direction_not_finite,
  no_direction,
  direction_not_unit,
  flux_not_finite,
  negative_flux
};

/// The first thing that is wrong with a ray as stored, or nothing.
std::optional<RayFault> fault_of(const SourceRay& ray);

/// What and why and hint; where is the caller's.
ErrorParts words(RayFault fault);

RayField field_of(RayFault fault);

}  // namespace catoptric::rayfiles::detail
