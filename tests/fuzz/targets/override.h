#pragma once

#include <cmath>
#include <string_view>

#include "fuzz/support/scene_check.h"

namespace catoptric::fuzz {

/// `--set key=value` over the paper's scene; several overrides are separated by byte 0x1e.
inline void try_override(std::string_view input) {
  static const design::Settings base =
      design::Settings::read(CATOPTRIC_DATA "/paper/start_a.toml", design::scene_keys());
  std::string_view rest = input;
  accepted([&] {
    design::Settings settings = base;
    while (!rest.empty()) {
      const std::string_view one = rest.substr(0, rest.find('\x1e'));
      rest.remove_prefix(std::min(rest.size(), one.size() + 1));
      const auto equals = one.find('=');
      if (equals == std::string_view::npos) continue;
      settings.set({std::string(one.substr(0, equals)), std::string(one.substr(equals + 1)), "--set"});
    }
    check_scene(design::written_scene(settings));
  });
}

}  // namespace catoptric::fuzz
