#pragma once

#include <string_view>

#include "fuzz/targets/intensity_check.h"
#include "photometry/eulumdat.h"

namespace catoptric::fuzz {

/// EULUMDAT files: what is accepted has finite light, and is written and read back as the same numbers.
inline void try_eulumdat(std::string_view input) {
  accepted([&] {
    const photometry::EulumdatFile file = photometry::parse_eulumdat(input, "fuzz.ldt").file;
    const IntensityTable table = photometry::intensity_of(file);
    check_intensity(table);
    const auto written = photometry::eulumdat_of(table, {});  // refuses a dark one
    const auto again = photometry::parse_eulumdat(photometry::eulumdat_text(written), "fuzz.ldt");
    if (!(photometry::intensity_of(again.file) == table)) finding("another table");
  });
}

}  // namespace catoptric::fuzz
