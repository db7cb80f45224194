#pragma once

#include <string>
#include <vector>

#include "base/profile.h"
#include "base/units.h"
#include "design/settings.h"

namespace catoptric::design {

/// The scene's unit, mm when it names none.
LengthUnit scene_unit(const Settings& settings);

/// Writes the profile into the reflector's keys, in the scene's unit.
/// @in where: what a message about these keys names as their place
void put_profile(Settings& settings, const Profile& profile, const std::string& where);

/// Writes into `settings` what the scene left out, so that what follows needs no default of its own and
/// scene.toml is complete. A profile file is read here and replaced by its control points.
/// @out   notes on an imported profile
/// @fails CadError when a profile file cannot be used; InputError when a key without default is missing
std::vector<std::string> complete(Settings& settings);

}  // namespace catoptric::design
