#pragma once

#include <string_view>

#include "fuzz/targets/intensity_check.h"
#include "photometry/lm63.h"

namespace catoptric::fuzz {

/// IES files: what is accepted has finite light, and is written and read back as the same numbers.
inline void try_lm63(std::string_view input) {
  accepted([&] {
    const photometry::Lm63File file = photometry::parse_lm63(input, "fuzz.ies").file;
    const IntensityTable table = photometry::intensity_of(file);
    check_intensity(table);
    const auto again =
        photometry::parse_lm63(photometry::lm63_text(photometry::lm63_of(table, {})), "fuzz.ies");
    if (!(photometry::intensity_of(again.file) == table)) finding("another table");
  });
}

}  // namespace catoptric::fuzz
