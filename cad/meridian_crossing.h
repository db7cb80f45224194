#pragma once

#include <array>

#include "cad/meridian_isolate.h"
#include "cad/meridian_line.h"
#include "cad/meridian_pieces.h"

namespace catoptric::cad::meridian {

inline constexpr auto binomials = [] {
  std::array<std::array<double, most_coefficients>, most_coefficients> table{};
  for (std::size_t n = 0; n < most_coefficients; ++n) {
    table[n][0] = 1;
    for (std::size_t k = 1; k <= n; ++k) table[n][k] = table[n - 1][k - 1] + (k < n ? table[n - 1][k] : 0);
  }
  return table;
}();

/// Where on a piece a line crosses it, to some ten digits, and how F bends there: what costs least without
/// the digits that the squares in F lose.
template <typename Real>
struct CrossingGuess {
  Real u;     ///< of the piece, 0 to 1
  Real bend;  ///< F'' / F' by u

  /// Two steps of Halley's method from where the control polygon crosses zero.
  /// @in    Bernstein coefficients of F that change their sign once; used up
  template <std::size_t Size>
  CATOPTRIC_FORCE_INLINE void set(std::array<Real, Size>& f, std::size_t degree) {
    const std::size_t last = 2 * degree;
    const Real zero = Real(0);
    Real from = f[0], to = f[1], number = zero;
    for (std::size_t i = 1; i < last; ++i) {
      const auto ahead = (f[i] < zero) == (f[0] < zero);
      from = choose(ahead, f[i], from);
      to = choose(ahead, f[i + 1], to);
      number = choose(ahead, Real(static_cast<double>(i)), number);
    }
    u = (number + from / (from - to)) * (1.0 / static_cast<double>(last));
    for (std::size_t level = 1; level <= last; ++level)
      for (std::size_t i = last; i >= level; --i) f[i] = f[i] - f[i - 1];
    for (std::size_t i = 1; i < last; ++i) f[i] = f[i] * binomials[last][i];
    constexpr int steps = 2;
    for (int step = 0; step < steps; ++step) {
      Real value = f[last] * u + f[last - 1], slope = f[last], half_second = zero;
      for (std::size_t i = last - 1; i-- > 0;) {
        half_second = half_second * u + slope;
        slope = slope * u + value;
        value = value * u + f[i];
      }
      u = u - value * slope / (slope * slope - value * half_second);
      if (step == steps - 1) bend = 2.0 * half_second / slope;
    }
  }
};

/// Sums c[i] a^i b^(degree - i) of a half of a span, with their derivatives by a alone.
template <typename Real>
struct CurveSums {
  Real r, z, w, r_by_a, z_by_a, w_by_a;
};

template <typename Real>
CATOPTRIC_FORCE_INLINE CurveSums<Real> sums(const HalfSpan<Real>& half, std::size_t degree, const Real& a,
                                            const Real& b) {
  CurveSums<Real> p;
  p.r_by_a = half.rw[degree];
  p.z_by_a = half.zw[degree];
  p.w_by_a = half.w[degree];
  p.r = p.r_by_a * a + half.rw[degree - 1] * b;
  p.z = p.z_by_a * a + half.zw[degree - 1] * b;
  p.w = p.w_by_a * a + half.w[degree - 1] * b;
  Real power = b;
  for (std::size_t i = degree - 1; i-- > 0;) {
    power = power * b;
    p.r_by_a = p.r_by_a * a + p.r;
    p.z_by_a = p.z_by_a * a + p.z;
    p.w_by_a = p.w_by_a * a + p.w;
    p.r = p.r * a + half.rw[i] * power;
    p.z = p.z * a + half.zw[i] * power;
    p.w = p.w * a + half.w[i] * power;
  }
  return p;
}

/// Newton's method for f = |dz| R - sqrt(V^2 + skew^2), the unsquared F (see CrossingResidual), as a fraction
/// without its denominators: f W and its slope times b have the same zeros and steps, and cost one division
/// and one root. A crossing known to ten digits takes one step. There is no bracket; what leaves the piece or
/// does not settle has failed.
/// @error as refine()
template <typename Real>
struct CrossingNewton {
  using Truth = decltype(Real{} < Real{});
  /// One is usual. Towards a crossing that has another just beyond the end of its piece, each step comes
  /// only half the way.
  static constexpr int most_steps = 16;

  Real h, level, skew, steepness, scale;  ///< of the line
  Truth lower;                            ///< whether a is s
  Real lo, hi;                            ///< of a
  Real bend;                              ///< |F'' / F'| by a
  Real a;
  Truth active, failed;
  Real s, r, z;  ///< the crossing

  CATOPTRIC_FORCE_INLINE void set_line(const AxisLine<Real>& line) {
    h = line.h;
    level = line.level;
    skew = line.skew;
    steepness = absolute(line.dz);
    scale = line.scale;
  }

  /// @in    f, as CrossingGuess wants it, of the piece from `first` to `last` of the span
  template <std::size_t Size>
  CATOPTRIC_FORCE_INLINE void begin(std::array<Real, Size>& f, const Real& first, const Real& last,
                                    std::size_t degree) {
    CrossingGuess<Real> guess;
    guess.set(f, degree);
    const Real width = last - first;
    lower = last <= Real(0.5);
    lo = choose(lower, first, 1.0 - last);
    hi = lo + width;
    a = choose(lower, lo + width * guess.u, hi - width * guess.u);
    bend = absolute(guess.bend) / width;
    active = (a > lo) & (a < hi);
    failed = opposite(active);
  }

  /// Nothing is left to gain after a step whose square, times how f bends, is below a rounding. F = f g with
  /// g = |dz| R + sqrt(V^2 + skew^2) bends by f''/f' + 2 g'/g, so f by no more than `bend` and g's share.
  CATOPTRIC_FORCE_INLINE void step(const HalfSpan<Real>& half, std::size_t degree) {
    constexpr double rounding = Precision<double>::unit_roundoff;
    const double curl = 4.0 * static_cast<double>(degree);  // bends the derivative that is left out
    const Real zero = Real(0), b = 1.0 - a;
    const CurveSums<Real> p = sums(half, degree, a, b);
    const Real x = steepness * absolute(p.r);
    const Real x_by_a = steepness * choose(p.r < zero, -p.r_by_a, p.r_by_a);
    const Real v = h * p.z + level * p.w, v_by_a = h * p.z_by_a + level * p.w_by_a;
    const Real y = skew * p.w, y_by_a = skew * p.w_by_a;
    const Real squared = v * v + y * y, root = square_root(squared);
    const Real length = choose(root > zero, root, Real(1));
    const Real value = (x - root) * length;
    const Real climb = x_by_a * length, turn = v * v_by_a + y * y_by_a;
    const Truth calm = absolute(value) <= rounding * (x * length + absolute(v) * (scale * p.w));
    const Real move = choose(calm, zero, -(value * b) / (climb - turn));
    const Real next = a + move;
    const Truth inside = (next > lo) & (next < hi);
    const Real weight = squared * b, reach = rounding * choose(lower, next, 1.0 - next);
    const Truth last = calm | (absolute(move) <= 2.0 * reach) |
                       ((absolute(climb + turn) + (bend + curl) * weight) * (move * move) <= reach * weight);
    a = choose(active, next, a);
    failed |= active & opposite(inside);
    active &= inside & opposite(last);
  }

  CATOPTRIC_FORCE_INLINE void finish(const HalfSpan<Real>& half, std::size_t degree) {
    failed |= active;
    const Real b = 1.0 - a;
    const CurveSums<Real> p = sums(half, degree, a, b);
    const Real inverse = 1.0 / p.w;
    s = choose(lower, a, b);
    r = absolute(p.r) * inverse;
    z = p.z * inverse;
  }
};

}  // namespace catoptric::cad::meridian
