#include "base/profile_limits.h"

#include <algorithm>

namespace catoptric {

double weight_ratio(int degree, std::span<const ControlPoint> points) {
  const std::size_t together = static_cast<std::size_t>(degree) + 1;
  double greatest = 1;
  for (std::size_t i = 0; i + together <= points.size(); ++i) {
    const auto [least, most] = std::ranges::minmax(points.subspan(i, together), {},
                                                   [](const ControlPoint& point) { return point.weight; });
    greatest = std::max(greatest, most.weight / least.weight);
  }
  return greatest;
}

}  // namespace catoptric
