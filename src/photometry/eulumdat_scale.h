#pragma once

#include "photometry/eulumdat.h"

namespace catoptric::photometry {

/// How many cd the number 1 of a EULUMDAT file stands for. Longer than double, so that every intensity in
/// double has a text that comes back to it through the factor.
inline long double cd_per_stored(const EulumdatFile& file) {
  constexpr long double lumens = 1000;  // the file's values are per thousand of them
  return static_cast<long double>(file.lamps.front().flux_lm) * file.conversion_factor / lumens;
}

}  // namespace catoptric::photometry
