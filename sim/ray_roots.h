#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::sim {

/// Roots of a t^2 + 2 b t + c, rising; infinite where there are none. Of a ray that starts on the surface
/// only the root that is not its start.
/// @from  the larger root by the sum without cancellation, the other by Vieta
inline std::array<double, 2> ray_roots(double a, double b, double c, bool starts_here) {
  constexpr std::array none{HUGE_VAL, HUGE_VAL};
  if (!(a > 0)) return none;
  if (starts_here) return {-2 * b / a, HUGE_VAL};
  const double square = b * b - a * c;
  if (!(square >= 0)) return none;
  const double q = -(b + std::copysign(std::sqrt(square), b));
  const double one = q / a, other = q != 0 ? c / q : HUGE_VAL;
  return {std::min(one, other), std::max(one, other)};
}

}  // namespace catoptric::sim
