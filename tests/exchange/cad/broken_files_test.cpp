#include <catch2/catch.hpp>
#include <random>

#include "cad/export.h"
#include "cad/profile_import.h"
#include "support/cad/profile_files.h"
#include "support/cad/sample_profiles.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using test::IgesText;
using test::TemporaryFolder;

namespace {

/// Imports the text; what is not a profile must be a CadError with all its parts.
void survive(const TemporaryFolder& folder, const std::string& text, const char* name, int& refused) {
  test::write_whole(folder / name, text);
  try {
    cad::import_profile(folder / name);
  } catch (const CadError& error) {
    ++refused;
    CHECK(!error.parts().what.empty());
    CHECK(!error.parts().hint.empty());
  }
}

std::string step_text() {
  const TemporaryFolder folder;
  cad::export_reflector(test::paraboloid(), folder / "mirror.step");
  return test::read_whole(folder / "mirror.step");
}

std::string iges_surface_text() {
  const TemporaryFolder folder;
  cad::export_reflector(test::paraboloid(), folder / "mirror.igs");
  return test::read_whole(folder / "mirror.igs");
}

}  // namespace

TEST_CASE("What is no exchange file is refused") {
  const TemporaryFolder folder;
  int refused = 0;
  const std::string binary(
      "\x7f"
      "ELF\0\0\1\2\3",
      9);
  for (const std::string& text :
       {std::string(), std::string(" \n\n"), std::string("solid ascii stl\n"), binary, std::string(200, '\0'),
        std::string("ISO-10303-21;"), std::string("ISO-10303-21;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"),
        std::string(72, ' ') + "S      1\n", std::string(72, ' ') + "B      1\n"})
    survive(folder, text, "broken.igs", refused);
  CHECK(refused == 9);
  CHECK_THROWS_WITH(cad::import_profile(folder / "missing.igs"), Catch::Contains("no such file"));
  CHECK_THROWS_WITH(cad::import_profile(folder.path()), Catch::Contains("not a file"));
}

TEST_CASE("A file cut off anywhere is refused") {
  const TemporaryFolder folder;
  for (const std::string& whole : {step_text(), iges_surface_text(), test::start_a_text()}) {
    int refused = 0;
    // The last line may be cut within its padding; before that something is missing.
    const std::size_t least = whole.size() - 90;
    for (int i = 1; i <= 12; ++i) survive(folder, whole.substr(0, least * i / 12), "cut.igs", refused);
    CHECK(refused == 12);
  }
}

TEST_CASE("Wrong characters: a profile or a refusal, never a crash", "[long]") {
  const TemporaryFolder folder;
  int refused = 0;
  constexpr int tries = 60;  // a fixed sample; the same mutations run by the thousand found nothing else
  for (const std::string& whole : {step_text(), iges_surface_text(), test::start_a_tilted_text()})
    for (int i = 0; i < tries; ++i) {
      std::mt19937 random(static_cast<unsigned>(i));
      std::string text = whole;
      for (unsigned k = 0; k <= random() % 6; ++k) {
        const std::size_t at = random() % text.size();
        if (random() % 3 == 0)
          text.erase(at, random() % 60);
        else
          text[at] = "0123456789,.;#*()$' X"[random() % 21];
      }
      survive(folder, text, "wrong.igs", refused);
    }
  CHECK(refused > tries);  // or nothing was broken at all
}

TEST_CASE("Numbers that are none") {
  const TemporaryFolder folder;
  int refused = 0;
  for (const char* number : {"1.E999", "-1.E999", "NAN", "INF", "1.E-999", "", "1.5.5", "1D400"}) {
    std::string text = test::start_a_text();
    const std::size_t at = text.find("9.,0.,5.");
    REQUIRE(at != std::string::npos);
    const std::string replacement = std::string(number) + ",0.,5.";
    text.replace(at, 8, replacement);
    // Keep the columns: take or give blanks before column 65.
    const std::size_t mark = text.find(';', at) + 1;
    if (replacement.size() > 8)
      text.erase(mark, replacement.size() - 8);
    else
      text.insert(mark, 8 - replacement.size(), ' ');
    survive(folder, text, "number.igs", refused);
  }
  CHECK(refused >= 2);
}

TEST_CASE("A count that is not true kills the reading process, not us", "[long]") {
  const TemporaryFolder folder;
  int refused = 0;
  for (const char* count : {"100000", "9999999", "999999999", "-5"}) {
    IgesText file;
    file.add(
        {126, 0, std::string(count) + ",2,0,0,0,0,0.,0.,0.,1.,1.,1.,1.,1.,1.,0.,0.,10.,5.,0.,10.,9.,0.,5."});
    survive(folder, file.text(), "count.igs", refused);
  }
  CHECK(refused == 4);
}

TEST_CASE("The reading process leaves the settings and the lock as they were") {
  const TemporaryFolder folder;
  int refused = 0;
  survive(folder, step_text().substr(0, 3000) + "END-ISO-10303-21;", "broken.step", refused);
  CHECK(refused == 1);
  CHECK_NOTHROW(cad::export_reflector(test::paraboloid(), folder / "mirror.igs"));
  CHECK(cad::import_profile(folder / "mirror.igs").profile == test::paraboloid());
}
