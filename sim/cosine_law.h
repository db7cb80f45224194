#pragma once

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace catoptric::sim {

/// How brightness goes with the cosine to an axis. Like cosine^exponent before it, with nothing behind; the
/// exponent 0 is another law: the same in all directions, behind too, and so without an axis. Or like the
/// sine, as a rod's seen from aside, before and behind.
struct CosineLaw {
  double exponent = 0;
  bool is_sine = false;
  static constexpr CosineLaw lambert() { return {1}; }
  static constexpr CosineLaw sine() { return {0, true}; }

  bool is_even() const { return exponent == 0 && !is_sine; }
  bool lights_behind() const { return exponent == 0; }

  /// Brightness over the greatest.
  double operator()(double cosine) const {
    if (is_sine) return sine_of(cosine);
    if (is_even()) return 1;
    return cosine > 0 ? raised(cosine, exponent) : 0;
  }

  /// Integral of the brightness over the cosine, from 0 on; odd, so that it serves axes up and down.
  double integral(double cosine) const {
    if (is_sine) return 0.5 * (cosine * sine_of(cosine) + std::asin(std::clamp(cosine, -1.0, 1.0)));
    if (is_even()) return cosine;
    const double power = exponent + 1;
    return std::copysign(raised(std::abs(cosine), power) / power, cosine);
  }

  /// The cosine that has this integral.
  double inverse(double integral) const {
    if (is_sine) return sine_inverse(integral);
    if (is_even()) return integral;
    const double power = exponent + 1;
    return std::copysign(root(std::abs(integral) * power, power), integral);
  }

  /// Brightness in all directions together over the greatest, sr.
  double total_sr() const { return is_sine ? pi * pi : is_even() ? 4 * pi : 2 * pi / (exponent + 1); }

 private:
  // Lambert's law is so common that it gets its square root.
  static double raised(double x, double power) {
    return power == 1 ? x : power == 2 ? x * x : std::pow(x, power);
  }
  static double root(double x, double power) { return power == 2 ? std::sqrt(x) : std::pow(x, 1 / power); }

  static double sine_of(double cosine) { return std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine))); }

  /// With the cosine sin(a / 2) the integral is (a + sin a) / 4: Kepler's equation at eccentricity 1, turned
  /// round by b = pi - a into b - sin b, where Newton's steps from above never pass the root.
  static double sine_inverse(double integral) {
    const double wanted = std::max(0.0, pi - 4 * std::abs(integral));
    double b = std::min(pi, std::cbrt(6 * wanted) * (1 + 0.05 * std::cbrt(wanted * wanted)));
    for (int i = 0; i < 20 && b > 0; ++i) {
      const double step = (b - std::sin(b) - wanted) / (1 - std::cos(b));
      b = std::clamp(b - step, 0.0, pi);
      if (std::abs(step) <= 1e-15 * b) break;
    }
    return std::copysign(std::cos(0.5 * b), integral);
  }
};

}  // namespace catoptric::sim
