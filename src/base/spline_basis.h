#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace catoptric {

/// The B-spline basis functions that do not vanish at a parameter, with their derivatives by it.
struct SplineBasis {
  std::size_t first = 0;             ///< control point that value[0] belongs to
  std::vector<double> value, slope;  ///< degree + 1 of each
};

/// @in    degree at least 1; flat knots as Profile takes them; u within the range that they span
/// @out   values that add up to 1, slopes that add up to 0
/// @from  Piegl & Tiller, The NURBS Book, 2nd ed., algorithms A2.1 to A2.3
SplineBasis spline_basis(int degree, std::span<const double> knots, double u);

}  // namespace catoptric
