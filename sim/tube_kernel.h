#pragma once

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace catoptric::sim {

/// Highest value of the Silverman kernel over its area: what one watt at one point can make, W/mm^2.
inline double kernel_peak_per_mm2(double radius_mm) { return 3 / (pi * radius_mm * radius_mm); }

/// The share of a ring of radius `ring_mm` that can lie within `radius_mm` of any one point.
inline double ring_share(double ring_mm, double radius_mm) {
  return ring_mm > radius_mm ? std::asin(radius_mm / ring_mm) / pi : 1.0;
}

/// What one watt, spread evenly over a ring about the axis, gives at distance `at_mm` from the axis under the
/// Silverman kernel of radius `radius_mm`, W/mm^2: the mean over the ring of 3 (1 - d^2 / h^2)^2 / (pi h^2).
///
/// With d^2 = r^2 + q^2 - 2 r q cos(azimuth) the integrand is (a + b cos(azimuth))^2, which has an elementary
/// integral. Over a part of the ring, azimuth up to x, it is b^2 (2 y + y cos y - 3 sin y) / 4 with y = 2 x;
/// for small y by its series, since the terms cancel to the fifth order.
/// @error relative 1e-12 where the ring is not within 1e-4 of the kernel's edge
/// @from  Silverman 1986 eq. 4.5; the integral by hand
inline double tube_kernel_per_mm2(double at_mm, double ring_mm, double radius_mm) {
  const double r = at_mm / radius_mm, q = std::abs(ring_mm) / radius_mm;
  const double b = 2 * r * q, apart = r - q;
  const double nearest = (1 - apart) * (1 + apart);  // a + b
  if (!(nearest > 0)) return 0;
  const double peak = kernel_peak_per_mm2(radius_mm);
  if (nearest >= 2 * b) {  // the whole ring
    const double a = nearest - b;
    return peak * (a * a + 0.5 * b * b);
  }
  const double y = 4 * std::asin(std::sqrt(0.5 * nearest / b));
  if (!(y < 1.5)) return peak * b * b * 0.25 * (2 * y + y * std::cos(y) - 3 * std::sin(y)) / pi;
  // At y = 1.5 the form above has lost three digits; eight terms of the series leave less than 1e-16 there.
  constexpr double coefficients[] = {
      2.0 / 120,          -4.0 / 5040,          6.0 / 362880,          -8.0 / 39916800.,
      10.0 / 6227020800., -12.0 / 1307674368e3, 14.0 / 355687428096e3, -16.0 / 121645100408832e3};
  const double s = y * y;
  double sum = 0;
  for (int i = 7; i >= 0; --i) sum = sum * s + coefficients[i];
  return peak * b * b * 0.25 * y * s * s * sum / pi;
}

}  // namespace catoptric::sim
