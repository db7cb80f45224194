#pragma once

#include <cmath>

#include "base/units.h"

namespace catoptric::sim {

/// How brightness falls with the cosine to an axis: like cosine^exponent before it, with nothing behind.
/// Exponent 0 is another law: the same in all directions, behind too, and so without an axis.
struct CosineLaw {
  double exponent = 0;

  bool is_even() const { return exponent == 0; }

  /// Brightness over that along the axis.
  double operator()(double cosine) const {
    if (is_even()) return 1;
    return cosine > 0 ? raised(cosine, exponent) : 0;
  }

  /// Integral of the brightness over the cosine, from 0 on; odd, so that it serves axes up and down.
  double integral(double cosine) const {
    if (is_even()) return cosine;
    const double power = exponent + 1;
    return std::copysign(raised(std::abs(cosine), power) / power, cosine);
  }

  /// The cosine that has this integral.
  double inverse(double integral) const {
    if (is_even()) return integral;
    const double power = exponent + 1;
    return std::copysign(root(std::abs(integral) * power, power), integral);
  }

  /// Brightness in all directions together over that along the axis, sr.
  double total_sr() const { return is_even() ? 4 * pi : 2 * pi / (exponent + 1); }

 private:
  // Lambert's law is so common that it gets its square root.
  static double raised(double x, double power) {
    return power == 1 ? x : power == 2 ? x * x : std::pow(x, power);
  }
  static double root(double x, double power) { return power == 2 ? std::sqrt(x) : std::pow(x, 1 / power); }
};

}  // namespace catoptric::sim
