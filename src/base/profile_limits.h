#pragma once

#include <cstddef>
#include <span>

#include "base/profile.h"

namespace catoptric {

/// Most control points of a generatrix: a CAD file's polyline has some thousand, and a search or a shadow
/// test asks every span.
inline constexpr std::size_t most_control_points = 10000;

/// Greatest ratio of weights that act on one span. Near the span's end a rounding of the parameter moves a
/// point by this times a rounding of the part. At 1e8 the two sides that a level ray meets there are no
/// longer told apart (one hit was a quarter of the part off); at 1e6 all are.
inline constexpr double greatest_weight_ratio = 1e6;

/// The greatest ratio of weights that act on one span.
/// @in    positive weights, more of them than the degree
double weight_ratio(int degree, std::span<const ControlPoint> points);

}  // namespace catoptric
