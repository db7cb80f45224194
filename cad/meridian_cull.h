#pragma once

#include <algorithm>
#include <cmath>

#include "cad/meridian_line.h"

namespace catoptric::cad::meridian {

/// The stretch of a line in which hits are wanted, and the test of rings against it. Errs towards looking:
/// the slack is far above any rounding, so what it rejects cannot be met, nor can its ends.
template <typename Real>
struct Culler {
  using Truth = decltype(Real{} < Real{});

  Real inverse, across_squared, slack, from, until;
  Truth steep;  ///< else heights do not tell where along the line a point is

  /// For hits beyond `beyond_mm` along the ray.
  CATOPTRIC_FORCE_INLINE void set(const AxisLine<Real>& line, const Real& shift, double beyond_mm,
                                  double size) {
    constexpr double generous = 1e-9;  // far above any rounding of t
    inverse = 1.0 / line.dz;
    across_squared = line.across * line.across;
    slack = generous * (size + absolute(shift));
    from = beyond_mm - shift - slack;
    until = Real(HUGE_VAL);
    steep = absolute(line.dz) >= Real(0x1p-10);
  }

  /// A hit at t was found; none beyond it is wanted any more.
  void found(double t) { found(t, t); }
  /// A hit between `least` and `most` of t is certain.
  void found(double least, double most) {
    if (least >= from + 2 * slack) until = std::min(until, most + slack);
  }
};

}  // namespace catoptric::cad::meridian
