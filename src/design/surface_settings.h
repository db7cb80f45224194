#pragma once

#include <optional>

#include "design/settings.h"
#include "sim/material.h"

namespace catoptric::design {

/// Writes the defaults of the mirror's and the near field's surface in.
/// @fails InputError for a surface that is described twice or by half, or that an invisible near field has
void complete_surfaces(Settings& settings);

/// The mirror's surface of complete settings.
/// @fails InputError for shares that add up to more than 1, angles that do not rise
sim::Material mirror_material(const Settings& settings);

/// Likewise the near field's; nothing where it is invisible.
std::optional<sim::Material> near_field_material(const Settings& settings);

}  // namespace catoptric::design
