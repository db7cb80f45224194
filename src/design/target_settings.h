#pragma once

#include "design/scene.h"
#include "design/settings.h"

namespace catoptric::design {

/// Checks that the keys of `target` fit its kind, and fills in what follows from others.
/// @fails InputError for a key that is missing, or that has no effect with this kind
void complete_target(Settings& settings);

/// The target's numbers, in mm and W/mm^2; tables along the radius are read here.
/// @in    settings completed; reference: the reference reflector where there is one
/// @fails InputError for numbers that make no target
TargetSpec target_spec(const Settings& settings, double unit_mm, std::optional<Profile> reference);

/// Targets about the axis need a near field across it.
/// @fails InputError when it is tilted
void check_across_axis(const Settings& settings, const TargetSpec& spec, const sim::NearField& field);

/// Adds what is worth telling of a target on its near field: how far a picture is from symmetric about the
/// axis, where the near field lies across it.
void add_field_notes(TargetSpec& spec, const sim::NearField& field);

}  // namespace catoptric::design
