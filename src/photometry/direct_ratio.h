#pragma once

#include <array>

#include "base/intensity_table.h"

namespace catoptric::photometry {

/// Indices of the rooms that EULUMDAT lists direct ratios for.
inline constexpr std::array<double, 10> room_indices{0.6, 0.8, 1, 1.25, 1.5, 2, 2.5, 3, 4, 5};

/// Share of the downward flux that falls straight on the floor of a square room, luminaires spread evenly
/// over all of its ceiling. With a room of width w and height h, k = w / (2 h), and a ray (gamma, C) meets
/// the floor from all places but those nearer to a wall than tan(gamma) h |cos C| or tan(gamma) h |sin C|:
/// the share (1 - tan gamma |cos C| / 2k)(1 - tan gamma |sin C| / 2k).
/// @in    room_index k > 0
/// @out   0 to 1; 0 when no light goes down
/// @error by the midpoint rule, below 1e-4 (1 degree by 3 degrees)
double direct_ratio(const IntensityTable& table, double room_index);

}  // namespace catoptric::photometry
