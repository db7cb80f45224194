#pragma once

#include <cmath>
#include <string_view>

#include "fuzz/support/scene_check.h"

namespace catoptric::fuzz {

/// Text of a scene file, up to a valid scene; nothing is tailored or traced.
inline void try_scene(std::string_view input) {
  accepted([&] {
    check_scene(
        design::written_scene(design::Settings::parse(input, "fuzz/scene.toml", design::scene_keys())));
  });
}

}  // namespace catoptric::fuzz
