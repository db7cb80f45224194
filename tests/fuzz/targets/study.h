#pragma once

#include <cmath>
#include <string_view>

#include "design/study.h"
#include "fuzz/support/scene_check.h"

namespace catoptric::fuzz {

/// Text of a study file, and what its runs change of the paper's scene.
inline void try_study(std::string_view input) {
  static const design::Settings base =
      design::Settings::read(CATOPTRIC_DATA "/paper/start_a.toml", design::scene_keys());
  accepted([&] {
    const design::Study study = design::parse_study(input, "fuzz/study.toml");
    constexpr std::size_t most = 20;  // runs, or long studies take all the time
    for (std::size_t i = 0; i < std::min(study.runs.size(), most); ++i) {
      design::Settings settings = base;
      for (const design::Override& change : study.runs[i].changes) settings.set(change);
      check_scene(design::written_scene(settings));
    }
  });
}

}  // namespace catoptric::fuzz
