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

/// The Silverman kernel's mean over a ring about the axis, and its derivative by the ring's radius.
struct RingMean {
  double value, slope;
};

/// Mean of (1 - d^2)^2 over a ring of radius `ring` about the axis, d from a point at distance `at`; lengths
/// in kernel radii. Times kernel_peak_per_mm2 it is what one watt spread over the ring gives.
///
/// With d^2 = r^2 + q^2 - 2 r q cos(azimuth) the integrand is (a + b cos(azimuth))^2, b = 2 r q. A whole ring
/// gives a^2 + b^2 / 2. A part gives b^2 f(v) with v = (a + b) / (2 b) and f'' = 16/pi asin(sqrt v): a power
/// v^(5/2) times a series of positive terms, which twelve terms replace up to v = 1/2; above, f is the whole
/// ring less f(1 - v).
/// @in    at, ring >= 0
/// @error relative 1e-12; next to the kernel's edge, whose place is known to a rounding, absolute 1e-15
/// @cost  one division, one square root; no branches, so that loops over it are done in vector lanes
/// @from  Silverman 1986 eq. 4.5; the integral by hand, its series economized (Chebyshev) over [0, 1/2]
__attribute__((always_inline)) inline RingMean kernel_ring_mean(double at, double ring) {
  constexpr double least_b = 1e-200;  // keeps 0/0 out; b^2 is nothing then
  constexpr double series[] = {0.2666666666666473,     0.019047619058543425,   0.004761903744479952,
                               0.0018037887582483278,  0.0008491549347287004,  0.00046645497670983783,
                               0.00022048132259911029, 0.00040312267940587336, -0.0005524057181764386,
                               0.0013142025178191229,  -0.0012813267204195508, 0.000730969458371543};
  const double b = std::max(2 * at * ring, least_b), apart = at - ring, both = at + ring;
  const double nearest = (1 - apart) * (1 + apart);  // a + b
  const double a = nearest - b;
  const double part = nearest / (2 * b), rest = std::max((both - 1) * (both + 1) / (2 * b), 0.0);
  const bool few = part <= 0.5;
  const double v = few ? std::max(part, 0.0) : rest;
  double sum = 0, slope = 0;
  for (int k = 11; k >= 0; --k) {
    sum = sum * v + series[k];
    slope = slope * v + (k + 2.5) * series[k];
  }
  const double power = v * std::sqrt(v) * (16 / pi);
  const double f = power * v * sum, df = power * slope;
  // By the ring: of b^2 f(v), v being nearest or rest over 2 b.
  const double b_slope = 2 * at;
  const double by_v = few ? apart : both;
  const double part_slope = b * (b_slope * (2 * f - v * df) + df * by_v);
  const double whole = a * a + 0.5 * b * b, whole_slope = 2 * a * (2 * apart - b_slope) + b * b_slope;
  const bool reached = nearest > 0;
  return {reached ? (few ? b * b * f : whole - b * b * f) : 0.0,
          reached ? (few ? part_slope : whole_slope - part_slope) : 0.0};
}

}  // namespace catoptric::sim
