#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace catoptric::sim {

/// The places in (-1, 1) at which a polynomial sum c[k] x^k changes its sign, ascending: between the roots of
/// its derivative there is one or none. Returns how many.
/// @error one rounding of 1
template <std::size_t degree>
std::size_t sign_changes(const std::array<double, degree + 1>& c, std::array<double, degree>& roots) {
  const auto value = [&](double x) {
    double sum = 0;
    for (std::size_t k = degree + 1; k-- > 0;) sum = sum * x + c[k];
    return sum;
  };
  std::array<double, degree + 1> cuts{};
  std::size_t count = 0, found = 0;
  if constexpr (degree > 1) {
    std::array<double, degree> derivative;
    for (std::size_t k = 0; k < degree; ++k) derivative[k] = static_cast<double>(k + 1) * c[k + 1];
    std::array<double, degree - 1> turns;
    count = sign_changes<degree - 1>(derivative, turns);
    std::copy_n(turns.begin(), count, cuts.begin());
  }
  cuts[count++] = 1;
  double low = -1;
  for (std::size_t i = 0; i < count; low = cuts[i++]) {
    double left = low, right = cuts[i];
    const bool rises = value(left) < 0;
    if (rises == (value(right) < 0)) continue;
    for (int bit = 0; bit < 53; ++bit) {
      const double middle = 0.5 * (left + right);
      ((value(middle) < 0) == rises ? left : right) = middle;
    }
    roots[found++] = left;
  }
  return found;
}

}  // namespace catoptric::sim
