#pragma once

#include <cmath>
#include <string>

#include "design/scene.h"
#include "fuzz/support/accepted.h"

namespace catoptric::fuzz {

/// A scene that was accepted is finite, and its text reads back as the same scene.
inline void check_scene(const design::Scene& scene) {
  for (const ControlPoint& point : scene.profile.points())
    if (!(std::abs(point.r_mm) < HUGE_VAL && std::abs(point.z_mm) < HUGE_VAL && point.weight > 0))
      finding("a profile that is not finite");
  if (!(scene.profile.diagonal_mm() < HUGE_VAL)) finding("a profile without a size");
  if (scene.settings.text("start") == "tailored")
    return;  // its mirror is to be made yet, and then written out
  const std::string text = design::scene_text(scene);
  const design::Scene again =
      design::written_scene(design::Settings::parse(text, "again.toml", design::scene_keys()));
  if (design::scene_text(again) != text) finding("the scene's text reads back as another scene:\n" + text);
  if (!(again.profile == scene.profile))
    finding("the scene's text reads back with another profile:\n" + text);
}

}  // namespace catoptric::fuzz
