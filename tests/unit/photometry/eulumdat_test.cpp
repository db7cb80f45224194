#include "photometry/eulumdat.h"

#include <catch2/catch.hpp>

#include "base/errors.h"
#include "support/photometric_texts.h"

using namespace catoptric;
using namespace catoptric::photometry;
using namespace catoptric::test;

namespace {

/// A file of so many even planes with two gamma angles; plane i of the stored ones has i + 1 at 90 degrees.
std::string ldt_of_symmetry(int symmetry, int planes, int stored) {
  std::string text = sound_ldt();
  text.resize(text.find("0\n90\n180\n270\n0\n45"));
  text = with_line(with_line(text, 3, std::to_string(symmetry)), 4, std::to_string(planes));
  text = with_line(with_line(with_line(text, 5, "0"), 6, "2"), 7, "90");
  for (int i = 0; i < planes; ++i) text += std::to_string(360.0 * i / planes) + "\n";
  text += "0\n90\n";
  for (int i = 0; i < stored; ++i) text += "0\n" + std::to_string(i + 1) + "\n";
  return text;
}

/// Values at 90 degrees of all planes, per thousand of the 2000 lm.
std::vector<double> values_of(int symmetry, int planes, int stored) {
  const IntensityTable table =
      intensity_of(parse_eulumdat(ldt_of_symmetry(symmetry, planes, stored), "a").file);
  std::vector<double> values;
  for (std::size_t i = 0; i < table.c_deg().size(); ++i) values.push_back(table.value(i, 1) / 2);
  return values;
}

void refused_line(std::size_t line, const std::string& text, const std::string& meaning,
                  const std::string& why) {
  INFO("line " << line << " is " << text);
  try {
    parse_eulumdat(with_line(sound_ldt(), line, text), "a.ldt");
    FAIL_CHECK("accepted");
  } catch (const InputError& error) {
    CHECK_THAT(error.parts().where, Catch::StartsWith("a.ldt:"));
    CHECK_THAT(error.parts().where, Catch::EndsWith(meaning));
    CHECK_THAT(error.what(), Catch::Contains(why));
  }
}

}  // namespace

TEST_CASE("a EULUMDAT file is read line by line, and a sound one gives no note") {
  const EulumdatReading reading = parse_eulumdat(sound_ldt(), "a.ldt");
  CHECK(reading.notes.empty());
  const EulumdatFile& file = reading.file;
  CHECK(file.company == "company");
  CHECK(file.symmetry == EulumdatSymmetry::both);
  CHECK(file.luminous_heights_mm == std::array<double, 4>{10, 11, 12, 13});
  CHECK(file.output_ratio_percent == 80);
  REQUIRE(file.lamps.size() == 1);
  CHECK(file.lamps[0] == EulumdatLamps{2, "LED", 2000, "4000", "80", 25});
  CHECK(file.direct_ratios[9] == 0.5);
  CHECK(opening_of(file) == LuminousOpening{90, 180, 13, false});
  const IntensityTable table = intensity_of(file);
  CHECK(table.c_deg() == std::vector<double>{0, 90, 180, 270});
  CHECK(table.at(0, 0) == 200);  // 100 cd/klm times 2 klm
  CHECK(table.at(45, 180) == 100);
  CHECK(table.at(45, 270) == 120);
}

TEST_CASE("stored planes stand for the full turn as Isym says") {
  CHECK(values_of(0, 4, 4) == std::vector<double>{1, 2, 3, 4});
  CHECK(values_of(1, 4, 1) == std::vector<double>{1});
  CHECK(values_of(2, 6, 4) == std::vector<double>{1, 2, 3, 4, 3, 2});
  CHECK(values_of(3, 8, 5) == std::vector<double>{3, 4, 5, 4, 3, 2, 1, 2});  // C 270, 315, 0, 45, 90
  CHECK(values_of(4, 8, 3) == std::vector<double>{1, 2, 3, 2, 1, 2, 3, 2});
}

TEST_CASE("decimal commas, CR LF, blanks and Latin-1 are read in a EULUMDAT file") {
  std::string text = with_line(sound_ldt(), 50, " 50,25 ");
  text = with_line(text, 1, "M\xFCller");
  std::string with_cr;
  for (const char c : text) with_cr += c == '\n' ? "\r\n" : std::string(1, c);
  const EulumdatReading reading = parse_eulumdat(with_cr, "a.ldt");
  CHECK(reading.file.company == "M\xC3\xBCller");
  REQUIRE(reading.notes.size() == 1);
  CHECK(reading.file.intensity_cd[0] == 100.5);
}

TEST_CASE("a EULUMDAT file that breaks a rule is refused with line and meaning") {
  refused_line(2, "7", "type indicator Ityp", "from 0 to 3");
  refused_line(3, "5", "symmetry indicator Isym", "from 0 to 4");
  refused_line(4, "722", "number Mc of C planes", "from 1 to 721");
  refused_line(4, "6", "number Mc of C planes", "multiple of 4");
  refused_line(4, "many", "number Mc of C planes", "no finite number");
  refused_line(6, "362", "number Ng of intensities in a plane", "from 2 to 361");
  refused_line(16, "-1", "luminous area's length", "not negative");
  refused_line(24, "-1", "conversion factor for intensities", "above 0");
  refused_line(26, "0", "number of lamp sets", "from 1");
  refused_line(29, "0", "lamp set 1: total luminous flux", "per 1000 lm");
  refused_line(43, "5", "C angles", "begin at 0");
  refused_line(44, "100", "C angles", "no mirror image");
  refused_line(45, "45", "C angles", "ascend");
  refused_line(49, "60", "gamma angles", "from 0 to 90");
  refused_line(51, "-1", "intensities", "C = 0, gamma = 45");
  refused_line(51, "nan", "intensities", "no finite number");
  refused_line(51, "", "intensities", "no finite number");
}

TEST_CASE("wrong counts and truncated EULUMDAT files are refused") {
  CHECK_THROWS_WITH(parse_eulumdat(sound_ldt() + "7\n", "a.ldt"),
                    Catch::Contains("a.ldt:56") && Catch::Contains("follows the last"));
  CHECK(parse_eulumdat(sound_ldt() + "\n\nremark\n", "a.ldt").notes.size() == 1);
  CHECK_THROWS_WITH(parse_eulumdat(with_line(sound_ldt(), 3, "0"), "a.ldt"), Catch::Contains("room for"));
  const std::string sound = sound_ldt();
  for (std::size_t length = 0; length + 3 < sound.size(); ++length) {
    INFO(length);
    CHECK_THROWS_AS(parse_eulumdat(sound.substr(0, length), "a.ldt"), InputError);
  }
}

TEST_CASE("what is common and harmless in a EULUMDAT file is accepted and told") {
  const auto note = [](std::size_t line, const std::string& text, const std::string& part) {
    const EulumdatReading reading = parse_eulumdat(with_line(sound_ldt(), line, text), "a.ldt");
    INFO(text);
    REQUIRE(reading.notes.size() == 1);
    CHECK_THAT(reading.notes[0], Catch::Contains(part));
    return reading.file;
  };
  note(2, "1", "Isym was taken");
  note(5, "15", "C angles are not 15 degrees apart");
  note(7, "5", "gamma angles are not 5 degrees apart");
  note(22, "110", "downward flux fraction");
  CHECK(note(24, "0", "1 was taken").intensity_cd[0] == 200);
  CHECK(note(24, "1.5", "factor 1.5").intensity_cd[0] == 300);
  CHECK(parse_eulumdat(with_line(sound_ldt(), 25, ""), "a.ldt").notes.empty());
}

TEST_CASE("of several lamp sets the first is taken, and told") {
  std::string text = with_line(sound_ldt(), 26, "2");
  text = with_line(text, 32, "25\n1\nother\n9000\n3000\n90\n70");
  const EulumdatReading reading = parse_eulumdat(text, "a.ldt");
  REQUIRE(reading.notes.size() == 1);
  CHECK_THAT(reading.notes[0], Catch::Contains("Of 2 lamp sets the first"));
  CHECK(reading.file.lamps[1].flux_lm == 9000);
  CHECK(reading.file.intensity_cd[0] == 200);
}
