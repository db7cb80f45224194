#include <catch2/catch.hpp>
#include <set>

#include "photometry/eulumdat.h"
#include "photometry/lm63.h"
#include "support/photometric_texts.h"

using namespace catoptric;
using namespace catoptric::photometry;
using namespace catoptric::test;

TEST_CASE("random tables come back from IES and EULUMDAT to the same bits", "[long]") {
  std::set<EulumdatSymmetry> symmetries;
  for (std::uint64_t i = 0; i < 500; ++i) {
    INFO("table " << i);
    const IntensityTable table = random_table(i);
    Luminaire luminaire;
    if (i % 2 == 0) luminaire.lamp_flux_lm = 1234.5678 + static_cast<double>(i) / 3;
    for (const auto version : {Lm63Version::of_2002, Lm63Version::of_2019}) {
      const Lm63File file = lm63_of(table, luminaire, version);
      const Lm63Reading reading = parse_lm63(lm63_text(file), "a.ies");
      CHECK(reading.notes.empty());
      CHECK(reading.file == file);
      CHECK(intensity_of(reading.file) == table);
    }
    const EulumdatFile file = eulumdat_of(table, luminaire);
    const EulumdatReading reading = parse_eulumdat(eulumdat_text(file), "a.ldt");
    CHECK(reading.notes.empty());
    CHECK(reading.file == file);
    CHECK(intensity_of(reading.file) == table);
    symmetries.insert(file.symmetry);
  }
  CHECK(symmetries.size() == 5);  // or the tables leave a way of storing planes untried
}

TEST_CASE("what is read from EULUMDAT and written as IES is the same light") {
  for (std::uint64_t i = 0; i < 50; ++i) {
    const IntensityTable table = random_table(i);
    const IntensityTable once = intensity_of(parse_eulumdat(eulumdat_text(eulumdat_of(table, {})), "a").file);
    const IntensityTable twice = intensity_of(parse_lm63(lm63_text(lm63_of(once, {})), "a").file);
    CHECK(twice == table);
    CHECK(twice.flux() == table.flux());
  }
}
