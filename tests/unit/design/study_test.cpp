#include "design/study.h"

#include <catch2/catch.hpp>

#include "base/errors.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

/// Reads a study with that text.
Study study_of(const std::string& text) {
  const test::TemporaryFolder folder;
  test::write_whole(folder / "study.toml", text);
  return read_study(folder / "study.toml");
}

}  // namespace

TEST_CASE("the paper's Table 2 has its eight runs, starts, steps and accelerations") {
  const Study study = read_study(std::string(CATOPTRIC_DATA) + "/paper/table2.toml");
  REQUIRE(study.runs.size() == 8);
  const double step_r2[] = {1, 2, 0.5, 1, 1, 1, 2, 1}, acceleration[] = {1, 1, 1, 2, 0.5, 1, 1, 1};
  const double start_r2[] = {9, 9, 9, 9, 9, 7, 7, 5};
  for (std::size_t i = 0; i < 8; ++i) {
    const Scene scene = study_scene(study.runs[i], {{"model.photons", "5000", "test"}});
    INFO(study.runs[i].name);
    CHECK(scene.variables[1].step == step_r2[i]);
    CHECK(scene.variables[0].step == 0.5 * step_r2[i]);
    CHECK(scene.variables[1].start == start_r2[i]);
    CHECK(scene.search.acceleration == acceleration[i]);
    CHECK(scene.model.photons.photons == 5000);
    CHECK(study.runs[i].reference.size() == 6);
  }
}

TEST_CASE("bad studies are refused with their line") {
  const auto refused = [](const char* text, const char* part) {
    INFO(text);
    CHECK_THROWS_WITH(study_of(text), Catch::Contains(part));
  };
  refused("title = \"x\"", "no runs");
  refused("runs = 3", "no runs");
  refused("[[runs]]\nname = \"1\"", "has no scene");
  refused("scene = \"s.toml\"\n[[runs]]\nname = \"../up\"", "no name for a run");
  refused("scene = \"s.toml\"\n[[runs]]\nname = \"a\"\n[[runs]]\nname = \"a\"", "two runs are named");
  refused("scene = \"s.toml\"\n[[runs]]\nname = \"a\"\nsett = {}", "did you mean runs.set?");
  refused("scene = \"s.toml\"\n[[runs]]\nname = \"a\"\nreference = {w1 = \"one\"}", "no number");
  refused("command = \"destroy\"\nscene = \"s.toml\"\n[[runs]]\nname = \"a\"", "one of \"design\"");
  refused("[[runs]\n", "not valid TOML");
  CHECK_THROWS_WITH(read_study("/nonexistent/study.toml"), Catch::Contains("no such file"));
}
