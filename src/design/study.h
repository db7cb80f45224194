#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "design/run.h"
#include "design/scene.h"

namespace catoptric::design {

/// One variation of a scene.
struct StudyRun {
  std::string name;  ///< also the name of its folder
  std::filesystem::path scene;
  std::vector<Override> changes;
  std::vector<std::pair<std::string, double>> reference;  ///< figures from elsewhere, shown beside ours
};

/// A list of variations of a scene, run one after the other.
struct Study {
  std::string title;
  bool designs;  ///< true: `design` each; false: `simulate` each
  std::vector<StudyRun> runs;
};

/// Reads a study file:
///   title = "..."; command = "design"; scene = "start_a.toml"
///   [[runs]]
///   name = "1"; set = {"search.acceleration" = 2.0}; reference = {w1 = 1.0}
/// @fails InputError as for a scene; names must differ and be fit for folders
Study read_study(const std::filesystem::path& file);
Study parse_study(std::string_view text, const std::filesystem::path& name);

/// The scene of one run; `more` comes from the command line and wins.
/// @fails InputError
Scene study_scene(const StudyRun& run, const std::vector<Override>& more);

}  // namespace catoptric::design
