#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "cad/detail/conic_arc.h"
#include "fuzz/support/accepted.h"

namespace catoptric::fuzz {

/// Conic arcs of IGES files: six coefficients and two ends, as doubles.
inline void try_conic(std::string_view input) {
  std::array<double, 10> numbers{};
  std::memcpy(numbers.data(), input.data(), std::min(input.size(), sizeof numbers));
  accepted([&] {
    const auto& n = numbers;
    const cad::detail::ConicArc arc =
        cad::detail::conic_arc({n[0], n[1], n[2], n[3], n[4], n[5]}, {n[6], n[7]}, {n[8], n[9]});
    if (arc.points.size() < 3 || arc.points.size() % 2 == 0 || arc.weights.size() != arc.points.size() ||
        arc.knots.size() != arc.points.size() + 3)
      finding("an arc whose parts do not fit");
    for (const Vector2& point : arc.points)
      if (!point.allFinite()) finding("a point that is not finite");
    for (const double weight : arc.weights)
      if (!(weight > 0 && weight < HUGE_VAL)) finding("a weight that is none");
  });
}

}  // namespace catoptric::fuzz
