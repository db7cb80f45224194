#pragma once

#include <array>
#include <optional>

#include "sim/tube_map.h"

namespace catoptric::sim {

/// The two halves of a tube, each through three rays of its own: off by a sixty-fourth of what the tube is
/// off at its quarters, of which a sixteenth is counted. Nothing where one of the rays takes another path.
/// @cost five rays
std::optional<std::array<Tube, 2>> halves_of(const Tube& tube, const TubeTracer& tracer);
inline constexpr int rays_of_halving = 5;

}  // namespace catoptric::sim
