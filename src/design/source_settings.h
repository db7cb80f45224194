#pragma once

#include "design/candidate.h"
#include "design/settings.h"

namespace catoptric::design {

/// Writes the defaults of the source's keys in.
/// @fails InputError for keys that do not belong to the source's kind, or are missing
void complete_source(Settings& settings);

/// The key that says how much light a source has: "source.power" or "source.flux".
const char* power_key(LightQuantity quantity);

/// Whether the scene is in W or in lm: as its sources are.
/// @in    settings whose sources are complete
LightQuantity light_quantity(const Settings& settings);

/// The source of complete settings.
/// @fails InputError for an axis without direction
SourceSpec source_spec(const Settings& settings, double unit_mm);

/// Refuses a vector that is too short to say a direction.
/// @fails InputError naming the key
void require_direction(const Settings& settings, const char* path, const Vector3& vector);

}  // namespace catoptric::design
