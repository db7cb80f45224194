#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "sim/recorded_area.h"

namespace catoptric::sim {

/// Where a photon landed, in plane coordinates of the near field: all that an estimate needs of it.
struct StoredPhoton {
  double x_mm, y_mm;
};
static_assert(sizeof(StoredPhoton) == 16, "flight and map together take at most 32 bytes a photon");

/// Photons on one side of the plane, by bands of the recorded area from bottom to top. Each band becomes a
/// part of the map of its own, so that the map is built band by band: in parallel, and with the photons of
/// few bands twice in memory.
inline constexpr std::size_t photon_bands = 16;
using BandedPhotons = std::array<std::vector<StoredPhoton>, photon_bands>;

/// The band of a height on the recorded area.
class BandOf {
 public:
  explicit BandOf(const RecordedArea& area)
      : half_height_mm_(area.half_height_mm),
        per_mm_(static_cast<double>(photon_bands) / (2 * area.half_height_mm)) {}
  std::size_t operator()(double y_mm) const {
    const double band = (y_mm + half_height_mm_) * per_mm_;
    return band > 0 ? std::min(static_cast<std::size_t>(band), photon_bands - 1) : 0;
  }

 private:
  double half_height_mm_, per_mm_;
};

}  // namespace catoptric::sim
