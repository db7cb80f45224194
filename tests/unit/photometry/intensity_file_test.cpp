#include "photometry/intensity_file.h"

#include <catch2/catch.hpp>

#include "base/errors.h"
#include "support/photometric_texts.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::photometry;
using namespace catoptric::test;

TEST_CASE("one call reads both formats, with flux, watts and opening") {
  const TemporaryFolder folder;
  write_whole(folder / "a.ies", sound_ies());
  write_whole(folder / "a.LDT", sound_ldt());
  const MeasuredIntensity ies = read_intensity(folder / "a.ies");
  CHECK(ies.table.quantity() == LightQuantity::luminous);
  CHECK(ies.lamp_flux_lm == 1000);
  CHECK(ies.input_w == 10);
  CHECK(ies.opening.along_c0_mm == 200);
  CHECK(ies.notes.empty());
  const MeasuredIntensity ldt = read_intensity(folder / "a.LDT");
  CHECK(ldt.lamp_flux_lm == 2000);
  CHECK(ldt.input_w == 25);
  CHECK(ldt.opening.along_c90_mm == 180);
  CHECK(ldt.notes.empty());
}

TEST_CASE("content goes before the ending, and the note says so") {
  const TemporaryFolder folder;
  write_whole(folder / "a.ldt", sound_ies());
  write_whole(folder / "b.ies", sound_ldt());
  write_whole(folder / "c.txt", sound_ldt());
  write_whole(folder / "d.txt", "hello");
  write_whole(folder / "e.ies", "hello");
  const MeasuredIntensity ies = read_intensity(folder / "a.ldt");
  REQUIRE(ies.notes.size() == 1);
  CHECK_THAT(ies.notes[0], Catch::Contains("is .ldt, but"));
  CHECK(read_intensity(folder / "b.ies").notes.size() == 1);
  CHECK(read_intensity(folder / "c.txt").notes.empty());
  CHECK_THROWS_WITH(read_intensity(folder / "d.txt"), Catch::Contains(".ies or .ldt"));
  CHECK_THROWS_WITH(read_intensity(folder / "e.ies"), Catch::Contains("TILT="));
  CHECK_THROWS_WITH(read_intensity(folder / "none.ies"), Catch::Contains("no such file"));
}

TEST_CASE("Latin-1 is told once") {
  const TemporaryFolder folder;
  write_whole(folder / "a.ies", replaced(sound_ies(), "[MANUFAC] us", "[MANUFAC] M\xFCller"));
  CHECK(read_intensity(folder / "a.ies").notes.size() == 1);
}

TEST_CASE("a table is written by the ending and read back") {
  const TemporaryFolder folder;
  const IntensityTable table = random_table(3);
  for (const char* name : {"a.ies", "a.ldt"}) {
    write_intensity(folder / name, table, {});
    const MeasuredIntensity read = read_intensity(folder / name);
    CHECK(read.table == table);
    CHECK(!read.lamp_flux_lm);
    CHECK(read.notes.empty());
  }
  CHECK_THROWS_WITH(write_intensity(folder / "a.csv", table, {}), Catch::Contains(".ies or .ldt"));
  CHECK_THROWS_AS(write_intensity(folder / "none" / "a.ies", table, {}), IoError);
}
