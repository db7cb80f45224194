#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "design/scene.h"

namespace catoptric::test {

/// A scene text in which @5 stands for a length of 5 and %2 for an irradiance of 2, made `scale` times as
/// large: lengths times the scale, irradiances over its square, powers and all else as they are. By powers of
/// two every number is exact.
/// @in length_unit  mm of the scene's unit: lengths are written in it, irradiances stay in W/m^2
inline std::string scaled_text(const std::string& text, double scale, double length_unit = 1) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] != '@' && text[i] != '%') {
      result += text[i++];
      continue;
    }
    char* end = nullptr;
    const double value = std::strtod(text.c_str() + i + 1, &end);
    result += fmt::format("{}", text[i] == '@' ? value * scale / length_unit : value / (scale * scale));
    i = static_cast<std::size_t>(end - text.c_str());
  }
  return result;
}

using Keys = std::vector<std::pair<std::string, std::string>>;

inline design::Scene scene_of(const std::string& text, const Keys& changes = {}) {
  design::Settings settings = design::Settings::parse(text, "test.toml", design::scene_keys());
  for (const auto& [key, value] : changes) settings.set({key, value, "test"});
  return design::make_scene(std::move(settings));
}

}  // namespace catoptric::test
