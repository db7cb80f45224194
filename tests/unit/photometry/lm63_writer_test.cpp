#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "photometry/lm63.h"
#include "support/photometric_texts.h"

using namespace catoptric;
using namespace catoptric::photometry;
using namespace catoptric::test;

namespace {

IntensityTable table_of_planes() {
  return {LightQuantity::luminous, {0, 45, 90}, {0, 90, 200}, {1, 2, 3, 1, 5, 6, 1, 8, 9}};
}

}  // namespace

TEST_CASE("an IES file of 2019 says that it is simulated, absolute and in metres") {
  Luminaire luminaire;
  luminaire.test = "T1";
  luminaire.opening = {200, 200, 0, true};
  luminaire.input_w = 12.5;
  const IntensityTable table(LightQuantity::luminous, {0, 90}, {0}, {100, 0});
  CHECK(lm63_text(lm63_of(table, luminaire)) ==
        "IES:LM-63-2019\r\n[TEST] T1\r\n[TESTLAB] not stated\r\n[ISSUEDATE] not stated\r\n"
        "[MANUFAC] not stated\r\n[LUMCAT] not stated\r\n[LUMINAIRE] not stated\r\n[LAMP] not stated\r\n"
        "TILT=NONE\r\n1 -1 1 2 1 1 2 -0.2 -0.2 0\r\n1 1.00010 12.5\r\n0 90\r\n0\r\n100 0\r\n");
}

TEST_CASE("what is written as IES is read back without a note") {
  Luminaire luminaire;
  luminaire.lamp_count = 2;
  luminaire.lamp_flux_lm = 1500;
  luminaire.name = "a \"lamp\"\nof two lines";
  for (const auto version : {Lm63Version::of_2002, Lm63Version::of_2019}) {
    const Lm63File file = lm63_of(table_of_planes(), luminaire, version);
    const Lm63Reading reading = parse_lm63(lm63_text(file), "a.ies");
    CHECK(reading.notes.empty());
    CHECK(reading.file == file);
    CHECK(intensity_of(reading.file) == table_of_planes());
    CHECK(reading.file.lumens_per_lamp == 750);
    CHECK(reading.file.horizontal_deg == std::vector<double>{0, 90, 200, 360});
  }
}

TEST_CASE("a native IES file of types A and B with tilt is written as it stands") {
  Lm63File file = parse_lm63(sound_ies(), "a.ies").file;
  file.type = PhotometricType::b;
  file.tilt = Lm63Tilt{2, {0, 90}, {1, 0.1}};
  file.multiplier = 0.1;
  file.version = Lm63Version::of_1995;
  CHECK(parse_lm63(lm63_text(file), "a.ies").file == file);
}

TEST_CASE("no line of an IES file has more than 132 bytes, nor is a character cut") {
  Luminaire luminaire;
  for (int i = 0; i < 200; ++i) luminaire.name += i % 7 == 0 ? " x" : "\xC3\xBC";
  luminaire.lamp = std::string(500, 'y');
  std::vector<double> gamma, values;
  for (int i = 0; i <= 300; ++i) {
    gamma.push_back(i * 0.6);
    values.push_back(std::exp(i / 7.0));
  }
  gamma.back() = 180;
  const std::string text = lm63_text(lm63_of({LightQuantity::luminous, gamma, {0}, values}, luminaire));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    CHECK(line.size() <= 132);
    if (!line.empty()) CHECK((static_cast<unsigned char>(line[0]) & 0xC0) != 0x80);
  }
  const Lm63Reading reading = parse_lm63(text, "a.ies");
  CHECK(reading.notes.empty());
  std::string name = reading.file.keywords[5].value;
  std::replace(name.begin(), name.end(), '\n', ' ');
  CHECK(" " + name == luminaire.name);
}

TEST_CASE("watts per steradian are not written as candela") {
  const IntensityTable table(LightQuantity::radiant, {0, 90}, {0}, {100, 0});
  CHECK_THROWS_WITH(lm63_of(table, {}), Catch::Contains("W/sr"));
  CHECK_THROWS_WITH(lm63_of(table_of_planes(), {}, Lm63Version::of_1991), Catch::Contains("2002 or 2019"));
}
