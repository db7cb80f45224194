#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "support/catoptric_program.h"
#include "support/temporary_folder.h"

using namespace catoptric::test;

namespace {

/// A file's text without what may differ: how long it took, and how many threads were asked for.
std::string without_times(const std::filesystem::path& file) {
  std::istringstream lines(read_whole(file));
  const bool study = file.filename() == "study.csv";  // seconds are its last column
  std::string text, line;
  while (std::getline(lines, line)) {
    if (line.find("\"seconds") != std::string::npos || line.starts_with("threads = ") ||
        line.find("<dt>Time</dt>") != std::string::npos || line.find("<dt>Effort</dt>") != std::string::npos)
      continue;
    text += (study ? line.substr(0, line.rfind(',')) : line) + "\n";
  }
  return text;
}

/// Paths of all files under a folder, in order; a study's page, whose rows hold times, left out.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto name = std::filesystem::relative(entry.path(), folder);
    if (entry.is_regular_file() && name != "study/report.html") files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

TEST_CASE("every command writes the same bytes by 1, 2 and 7 threads, but for its times", "[long]") {
  const TemporaryFolder folder;
  write_whole(folder / "study.toml", "scene = '" + paper +
                                         "start_a.toml'\n[[runs]]\nname = \"a\"\n[[runs]]\nname = \"b\"\n"
                                         "set = {\"variables.w1.start\" = 1.0}\n");
  const std::vector<std::pair<std::string, std::string>> commands = {
      {"design", "design '" + examples + "ring.toml'" + small + " --set model.rung=photons"},
      {"simulate", "simulate '" + examples + "diffusing_floor.toml'" + small},
      {"landscape", "landscape '" + paper +
                        "start_a.toml' --set landscape.steps=[3,4] --set landscape.paths=true" + small},
      {"sensitivity", "sensitivity '" + paper + "paraboloid.toml'" + small},
      {"rays", "rays '" + examples + "source_aside.toml' --set rays.count=20001"},
      {"luminaire", "rays '" + examples + "disc_lamp.toml' --set rays.count=20001 --set rays.of=luminaire" +
                        " --set rays.format=zemax"},
      {"study", "study '" + (folder / "study.toml").string() + "'" + small}};
  for (const std::string threads : {"1", "2", "7"})
    for (const auto& [name, command] : commands) {
      const Ended ended = program_run(command + " --quiet --threads " + threads + " --out '" +
                                      (folder / threads / name).string() + "'");
      INFO(command << "\n" << ended.output);
      REQUIRE((ended.code == 0 || ended.code == 5));
    }
  const auto files = files_of(folder / "1");
  CHECK(files.size() > 50);
  for (const std::string threads : {"2", "7"}) {
    CHECK(files_of(folder / threads) == files);
    for (const auto& file : files) {
      INFO(threads << " threads: " << file);
      const bool same = without_times(folder / threads / file) == without_times(folder / "1" / file);
      CHECK(same);  // pages are too long to be shown
    }
  }
}
