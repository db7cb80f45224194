#pragma once

#include <string>

#include "design/run.h"

namespace catoptric::design {

/// The scene with a mirror that a search found: nothing is left to search, so that other commands
/// take the lamp as designed. Source and reflectance are the found ones too, where these were variables; a
/// target that is a reference mirror's light by the scene's own source is then left out.
/// @error lengths in other units than mm are rounded once
Scene designed_scene(const Scene& scene, const Judged& found);

/// The same as TOML.
std::string designed_text(const Scene& scene, const Judged& found);

}  // namespace catoptric::design
