#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "photometry/lm63.h"
#include "support/photometric_texts.h"
#include "support/program.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::photometry;
using namespace catoptric::test;

namespace {

/// The folder of the npm package three, whose IES reader is another's; empty when it is not installed.
std::string folder_of_three() {
  const Ended ended = run_shell("npm root -g");
  if (ended.code != 0) return {};
  const std::filesystem::path folder = ended.output.substr(0, ended.output.find('\n')) + "/three";
  return std::filesystem::exists(folder / "examples/jsm/loaders/IESLoader.js") ? folder.string()
                                                                               : std::string();
}

std::vector<double> numbers_of(std::istream& lines) {
  std::string line;
  std::getline(lines, line);
  std::istringstream words(line);
  std::vector<double> numbers;
  for (double number; words >> number;) numbers.push_back(number);
  return numbers;
}

}  // namespace

TEST_CASE("three.js reads our IES files as the same angles and the same light, where it is installed") {
  const std::string three = folder_of_three();
  if (three.empty()) {
    WARN("not installed: npm install -g three");
    return;
  }
  const TemporaryFolder folder;
  const std::string script = std::string(CATOPTRIC_DATA) + "/../tests/unit/photometry/three_ies.mjs";
  for (std::uint64_t i = 0; i < 6; ++i) {
    const IntensityTable table = random_table(i);
    const Lm63File file = lm63_of(table, {}, i % 2 == 0 ? Lm63Version::of_2019 : Lm63Version::of_2002);
    write_whole(folder / "a.ies", lm63_text(file));
    const Ended ended =
        run_shell("node '" + script + "' '" + three + "' '" + (folder / "a.ies").string() + "'");
    INFO(ended.output);
    REQUIRE(ended.code == 0);
    std::istringstream lines(ended.output);
    REQUIRE(numbers_of(lines).size() == 2);
    CHECK(numbers_of(lines) == file.vertical_deg);
    CHECK(numbers_of(lines) == file.horizontal_deg);
    for (std::size_t plane = 0; plane < file.horizontal_deg.size(); ++plane) {
      const std::vector<double> read = numbers_of(lines);
      REQUIRE(read.size() == file.vertical_deg.size());
      // It takes the code of 2019 for a factor, which goes out with the maximum it divides by: two roundings
      // each.
      for (std::size_t k = 0; k < read.size(); ++k)
        CHECK(read[k] * table.maximum() == Approx(file.candela[plane * read.size() + k]).epsilon(1e-15 * 4));
    }
  }
}
