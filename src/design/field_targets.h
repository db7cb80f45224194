#pragma once

#include "design/scene.h"
#include "design/target.h"

namespace catoptric::design {

/// Appends the samples of the scene's further fields with what is wanted there. Every sample then counts by
/// the area that it stands for, times its zone's or its field's weight; samples of fields where nothing is
/// wanted count nothing.
/// @in    a target of the near field alone, its parts marked
void append_fields(const Scene& scene, Target& target);

/// Samples of one field, in the order of the target: 0 the near field, then the further ones.
std::vector<std::size_t> samples_of_field(const Target& target, std::size_t field);

/// The same target without the further fields: what is drawn over the near field.
Target near_field_alone(const Target& target);

}  // namespace catoptric::design
