#pragma once

#include <cmath>

#include "base/intensity_table.h"
#include "fuzz/support/accepted.h"

namespace catoptric::fuzz {

/// A table whose light is finite, not negative and within its range.
inline void check_intensity(const IntensityTable& table) {
  const double flux = table.flux(), greatest = table.maximum();
  if (!(flux >= 0 && flux < HUGE_VAL)) finding("a flux that is none");
  for (const double gamma : {0.0, 33.3, 90.0, 180.0}) {
    const double intensity = table.at(gamma, 123.4);
    if (!(intensity >= 0 && intensity <= greatest)) finding("an intensity that is none");
  }
}

}  // namespace catoptric::fuzz
