#pragma once

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program.h"
#include "support/temporary_folder.h"

namespace catoptric::test {

/// The program under test: the one built with it, unless the environment names another (one under
/// sanitizers).
inline std::string program_under_test() {
  const char* named = std::getenv("CATOPTRIC_PROGRAM");
  return named ? named : CATOPTRIC_BUILT_PROGRAM;
}
inline const std::string program = program_under_test();
inline const std::string paper = std::string(CATOPTRIC_DATA) + "/paper/";
inline const std::string examples = std::string(CATOPTRIC_DATA) + "/examples/";

/// Few photons and a coarse end, so that a whole design takes a second.
inline const std::string small =
    " --set model.photons=4000 --set model.replicates=2 --set near_field.samples=60 --set "
    "search.smallest_step=0.1";

inline Ended program_run(const std::string& arguments) { return run_shell("'" + program + "' " + arguments); }

inline nlohmann::json parsed(const std::filesystem::path& file) {
  return nlohmann::json::parse(read_whole(file));
}

/// The part of a result that must repeat: all but how long it took.
inline nlohmann::json repeatable(const std::filesystem::path& file) {
  nlohmann::json value = parsed(file);
  value.erase("seconds");
  value.erase("seconds_search");
  return value;
}

}  // namespace catoptric::test
