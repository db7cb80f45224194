#pragma once

#include <string>
#include <vector>

#include "design/scene.h"

namespace catoptric::design {

/// The scene's settings with what `start = "tailored"` finds written into them, so that scene.toml needs no
/// tailoring again: the reflector where it is made from nothing, else the variables' starts.
/// @in    notes: takes what a user should know
/// @fails as tailored_from_nothing
Settings tailored_settings(const Scene& scene, bool from_nothing, std::vector<std::string>& notes);

}  // namespace catoptric::design
