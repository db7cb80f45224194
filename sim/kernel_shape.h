#pragma once

#include <cmath>

#include "sim/kernel.h"

namespace catoptric::sim {

/// The kernel as a function of t^2, which is what a search by squared distances has at hand; t^2 in [0, 1].
/// A template, so that a loop over photons holds no switch.
template <Kernel kernel>
[[gnu::always_inline]] inline double kernel_of_square(double t_squared) {
  const double rest = 1 - t_squared;
  if constexpr (kernel == Kernel::silverman) return 3 * rest * rest;
  if constexpr (kernel == Kernel::epanechnikov) return 2 * rest;
  if constexpr (kernel == Kernel::cone) return 3 * (1 - std::sqrt(t_squared));
  if constexpr (kernel == Kernel::constant) return 1;
  if constexpr (kernel == Kernel::gaussian) {
    constexpr double half_precision = 4.5;         // 1 / (2 sigma^2) for sigma = 1/3
    constexpr double kept = 0.988891003461757694;  // 1 - exp(-4.5): the share of the mass inside t = 1
    return half_precision / kept * std::exp(-half_precision * t_squared);
  }
}

/// Calls `action.template operator()<kernel>()` for the kernel named at run time. Always inlined, so that a
/// loop in the action is compiled for the caller's kind of processor.
template <typename Action>
[[gnu::always_inline]] inline auto with_kernel(Kernel kernel, const Action& action) {
  switch (kernel) {
    case Kernel::epanechnikov:
      return action.template operator()<Kernel::epanechnikov>();
    case Kernel::cone:
      return action.template operator()<Kernel::cone>();
    case Kernel::gaussian:
      return action.template operator()<Kernel::gaussian>();
    case Kernel::constant:
      return action.template operator()<Kernel::constant>();
    case Kernel::silverman:
      break;
  }
  return action.template operator()<Kernel::silverman>();
}

}  // namespace catoptric::sim
