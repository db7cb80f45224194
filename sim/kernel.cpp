#include "sim/kernel.h"

#include <array>
#include <cmath>
#include <utility>

#include "sim/kernel_shape.h"

namespace catoptric::sim {
namespace {

constexpr std::array<std::pair<Kernel, std::string_view>, 5> names{{{Kernel::silverman, "silverman"},
                                                                    {Kernel::epanechnikov, "epanechnikov"},
                                                                    {Kernel::cone, "cone"},
                                                                    {Kernel::gaussian, "gaussian"},
                                                                    {Kernel::constant, "constant"}}};

}  // namespace

double kernel_value(Kernel kernel, double t) {
  if (!(std::isgreaterequal(t, 0) && std::islessequal(t, 1))) return 0;  // quiet about NaN
  return with_kernel(kernel, [t]<Kernel k>() { return kernel_of_square<k>(t * t); });
}

double kernel_square_mean(Kernel kernel) {
  switch (kernel) {
    case Kernel::epanechnikov:
      return 4.0 / 3.0;
    case Kernel::cone:
      return 1.5;
    case Kernel::constant:
      return 1;
    case Kernel::gaussian:
      return 2.25 / std::tanh(2.25);  // c (1 - e^-2c) / (2 (1 - e^-c)^2) with c = 4.5
    case Kernel::silverman:
      break;
  }
  return 1.8;
}

std::string_view name(Kernel kernel) {
  for (const auto& [each, text] : names)
    if (each == kernel) return text;
  return "";
}

std::optional<Kernel> parse_kernel(std::string_view text) {
  for (const auto& [kernel, each] : names)
    if (each == text) return kernel;
  return std::nullopt;
}

}  // namespace catoptric::sim
