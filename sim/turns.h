#pragma once

#include <span>

namespace catoptric::sim {

/// Cosine and sine of angles given in full turns, many at a time, the same bits on every processor.
/// @in    turns in [0, 1]; all of one length
/// @error 1 rounding of 1 (2^-53 = 1.1e-16) in addition to that of the last step
/// @cost  about 1 ns an angle
void cosines_and_sines(std::span<const double> turns, std::span<double> cosines, std::span<double> sines);

}  // namespace catoptric::sim
