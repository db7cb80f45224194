#pragma once

#include <cstddef>

namespace catoptric {

/// Most control points of a generatrix: a CAD file's polyline has some thousand, and a search or a shadow
/// test asks every span.
inline constexpr std::size_t most_control_points = 10000;

}  // namespace catoptric
