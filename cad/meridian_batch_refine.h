#pragma once

#include <array>

#include "cad/meridian_batch_work.h"
#include "cad/meridian_refine.h"

namespace catoptric::cad::meridian {

/// A half of a span for each lane, in the order in which Horner's rule wants the coefficients there.
struct HalfSpans {
  std::array<Lanes, most_poles> rw, zw, w;
  Mask lower;

  /// evaluate<Degree>(span, s), for s on the lane's own half.
  CATOPTRIC_FORCE_INLINE CurvePoint<Lanes> evaluate(std::size_t degree, const Lanes& s) const {
    const Lanes one = Lanes(1), zero = Lanes(0);
    const Lanes rest = one - s;
    const Lanes x = one / choose(lower, rest, s);
    const Lanes q = choose(lower, s, rest) * x;
    const Lanes square = x * x;
    Lanes r = rw[degree], z = zw[degree], n = w[degree], dr = zero, dz = zero, dn = zero;
    for (std::size_t i = degree; i-- > 0;) {
      dr = dr * q + r;
      dz = dz * q + z;
      dn = dn * q + n;
      r = r * q + rw[i];
      z = z * q + zw[i];
      n = n * q + w[i];
    }
    const Lanes inverse = one / n;
    CurvePoint<Lanes> p;
    p.r = r * inverse;
    p.z = z * inverse;
    const Lanes factor = inverse * choose(lower, square, -square);
    p.dr = (dr - dn * p.r) * factor;
    p.dz = (dz - dn * p.z) * factor;
    const Mask beyond = p.r < zero;
    p.r = choose(beyond, -p.r, p.r);
    p.dr = choose(beyond, -p.dr, p.dr);
    return p;
  }
};

/// refine() for four crossings at a time, each in a bracket of its own.
struct NewtonLanes {
  HalfSpans halves;
  AxisLine<Lanes> line;
  Lanes s, lo, hi, sign_lo;
  CurvePoint<Lanes> point;
  Lanes last_step, last_slope;
  Mask active, failed;

  CATOPTRIC_FORCE_INLINE void begin(std::size_t degree) {
    active = (s > lo) & (s < hi);  // an end may be on the neighbour's half
    failed = ~active;
    last_step = last_slope = Lanes(0);
    point = halves.evaluate(degree, s);
  }

  /// @out   whether any crossing needs another step
  CATOPTRIC_FORCE_INLINE bool step(std::size_t degree) {
    constexpr double rounding = Precision<double>::unit_roundoff;
    const Lanes zero = Lanes(0);
    const Residual<Lanes> f = CrossingResidual<Lanes>{line}(point);
    active &= ~(absolute(f.value) <= f.noise);
    const Mask below = (f.value < zero) == (sign_lo < zero);
    lo = choose(below, s, lo);
    hi = choose(below, hi, s);
    const Lanes newton = -f.value / f.slope, half = (lo + hi) / 2.0 - s;
    const Mask inside = (s + newton > lo) & (s + newton < hi);
    const Lanes move = choose(inside, newton, half), next = s + move;
    active &= inside | ~(absolute(half) <= rounding * s);
    const Mask first = last_step == 0.0;
    const Lanes bend =
        absolute(choose(first, 1.0, f.slope - last_slope) / choose(first, move, f.slope * last_step));
    const Mask last = active & inside & is_last_step(bend, move, next);
    point.r = choose(last, point.r + point.dr * move, point.r);
    point.z = choose(last, point.z + point.dz * move, point.z);
    s = choose(active, next, s);
    active &= ~last;
    if (!any(active)) return false;
    last_step = choose(inside, move, 0.0);
    last_slope = f.slope;
    const CurvePoint<Lanes> at = halves.evaluate(degree, s);
    point.r = choose(active, at.r, point.r);
    point.z = choose(active, at.z, point.z);
    point.dr = at.dr;
    point.dz = at.dz;
    return true;
  }
};

}  // namespace catoptric::cad::meridian
