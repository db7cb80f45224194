#pragma once

#include "cad/meridian_line.h"
#include "cad/meridian_spans.h"

namespace catoptric::cad::meridian {

/// A point of the generatrix (z from the part's centre) with its derivatives by the span's parameter.
template <typename Real>
struct CurvePoint {
  Real r, z, dr, dz;

  /// A curve that touches the axis may pass it by a rounding; the surface is the same.
  void mirror() {
    if (r < 0) {
      r = -r;
      dr = -dr;
    }
  }
};

/// Point of a span at s in [0, 1]. `Degree` is known when compiling so that the loops vanish.
template <int Degree>
inline CurvePoint<double> evaluate(const SpanForm& span, double s) {
  const bool lower = s <= 0.5;
  const double x = 1 / (lower ? 1 - s : s);
  const double q = (lower ? s : 1 - s) * x;
  const double speed = lower ? x * x : -x * x;
  double rw, zw, w, drw = 0, dzw = 0, dw = 0;
  const auto horner = [&](const auto& at) {
    rw = span.rw[at(Degree)];
    zw = span.zw[at(Degree)];
    w = span.w[at(Degree)];
    for (int i = Degree - 1; i >= 0; --i) {
      drw = drw * q + rw;
      dzw = dzw * q + zw;
      dw = dw * q + w;
      rw = rw * q + span.rw[at(i)];
      zw = zw * q + span.zw[at(i)];
      w = w * q + span.w[at(i)];
    }
  };
  if (lower)
    horner([](int i) { return static_cast<std::size_t>(i); });
  else
    horner([](int i) { return static_cast<std::size_t>(Degree - i); });
  const double inverse = 1 / w;
  CurvePoint<double> p{rw * inverse, zw * inverse, 0, 0};
  const double factor = inverse * speed;
  p.dr = (drw - dw * p.r) * factor;
  p.dz = (dzw - dw * p.z) * factor;
  p.mirror();
  return p;
}

/// The same by de Casteljau, in any arithmetic.
template <typename Real>
CurvePoint<Real> evaluate(const Piece<Real>& span, int degree, Real s) {
  Homogeneous<Real> c = span.curve;
  Real drw = 0, dzw = 0, dw = 0;
  const Real rest = Real(1) - s, p = Real(degree);
  for (std::size_t level = static_cast<std::size_t>(degree); level >= 1; --level) {
    if (level == 1) {
      drw = p * (c.rw[1] - c.rw[0]);
      dzw = p * (c.zw[1] - c.zw[0]);
      dw = p * (c.w[1] - c.w[0]);
    }
    for (std::size_t i = 0; i < level; ++i) {
      c.rw[i] = rest * c.rw[i] + s * c.rw[i + 1];
      c.zw[i] = rest * c.zw[i] + s * c.zw[i + 1];
      c.w[i] = rest * c.w[i] + s * c.w[i + 1];
    }
  }
  CurvePoint<Real> point{c.rw[0] / c.w[0], c.zw[0] / c.w[0], 0, 0};
  point.dr = (drw - dw * point.r) / c.w[0];
  point.dz = (dzw - dw * point.z) / c.w[0];
  point.mirror();
  return point;
}

/// A function whose root is sought: its value, its derivative by the span's parameter, and what rounding may
/// make of a zero.
template <typename Real>
struct Residual {
  Real value, slope, noise;
};

/// f = |dz| R - |dz xy + (Z - oz) dxy|, the unsquared F: the distance from the axis of surface and line at
/// the same height, times |dz|. It is regular on the axis, where F is not.
template <typename Real>
struct CrossingResidual {
  const AxisLine<Real>& line;
  CATOPTRIC_FORCE_INLINE Real value(const Real& r, const Real& z) const {
    const Real v = line.h * z + line.level;
    return absolute(line.dz) * r - square_root(v * v + line.skew * line.skew);
  }
  CATOPTRIC_FORCE_INLINE Residual<Real> operator()(const CurvePoint<Real>& p) const {
    const Real zero = Real(0);
    const Real v = line.h * p.z + line.level;
    const Real length = square_root(v * v + line.skew * line.skew);
    const Real share = choose(length > zero, v / length, zero);
    const Real x = absolute(line.dz) * p.r;
    return {x - length, absolute(line.dz) * p.dr - share * line.h * p.dz,
            Precision<Real>::unit_roundoff * (x + absolute(share) * line.scale)};
  }
};

/// Z - oz, for lines in a plane across the axis.
template <typename Real>
struct LevelResidual {
  const AxisLine<Real>& line;
  Residual<Real> operator()(const CurvePoint<Real>& p) const {
    return {p.z - line.oz, p.dz, Precision<Real>::unit_roundoff * absolute(line.oz)};
  }
};

template <typename Real>
struct Root {
  Real s;
  CurvePoint<Real> point;
};

/// Whether nothing is left to gain after a Newton step to `next`. The step's own error is its square times
/// f''/(2 f'), of which the slopes give twice the value (`bend`); that of the point carried along is its
/// square times r''/2, for which `curl` stands.
template <typename Real>
CATOPTRIC_FORCE_INLINE auto is_last_step(const Real& bend, const Real& step, const Real& next) {
  constexpr auto rounding = Precision<Real>::unit_roundoff;
  const Real curl = 64.0;
  return ((bend + curl) * step * step <= rounding * next) | (absolute(step) <= 2.0 * rounding * next);
}

/// Newton's method kept inside a bracket whose lower end has the sign `sign_lo`; starts at `s`.
/// @error s to a rounding, or to where the residual is noise
/// @cost  four to six evaluations; at worst a few times the number of digits
template <typename Real, typename Function, typename Evaluate>
Root<Real> refine(const Function& function, const Evaluate& at, Real lo, Real hi, int sign_lo, Real s) {
  constexpr Real rounding = Precision<Real>::unit_roundoff;
  constexpr int most_steps = 400;
  Real last_step = 0, last_slope = 0;
  Root<Real> root{s, at(s)};
  for (int i = 0; i < most_steps; ++i) {
    const auto [value, slope, noise] = function(root.point);
    if (absolute(value) <= noise) break;
    ((value < 0) == (sign_lo < 0) ? lo : hi) = root.s;
    Real step = -value / slope;
    const bool inside = root.s + step > lo && root.s + step < hi;
    if (!inside) {
      step = (lo + hi) / 2 - root.s;
      if (absolute(step) <= rounding * root.s) break;
    }
    const Real next = root.s + step;
    if (inside) {
      const Real bend =
          last_step == 0 ? Real(1) / absolute(step) : absolute((slope - last_slope) / (slope * last_step));
      if (is_last_step(bend, step, next)) {
        root.point.r += root.point.dr * step;
        root.point.z += root.point.dz * step;
        root.s = next;
        break;
      }
    }
    last_step = inside ? step : Real(0);
    last_slope = slope;
    root.s = next;
    root.point = at(next);
  }
  return root;
}

/// Distance along the line to the point of the surface at (r, z), from the height or from the distance to
/// the axis, whichever changes faster along the line.
template <typename Real>
struct DistanceAlong {
  const AxisLine<Real>& line;
  const Real &r, &z;

  CATOPTRIC_FORCE_INLINE Real v() const { return line.h * z + line.level; }
  CATOPTRIC_FORCE_INLINE auto by_height_is_better() const {
    const Real steepness = absolute(line.dz);
    return (2.0 * steepness >= line.h) |
           ((steepness > Real(0)) & (steepness * steepness * r >= line.h * absolute(v())));
  }
  CATOPTRIC_FORCE_INLINE Real by_height() const { return (z - line.oz) / line.dz; }
  CATOPTRIC_FORCE_INLINE Real by_radius() const {
    const Real zero = Real(0);
    const Real squared = (r - line.across) * (r + line.across);
    const Real side = choose(squared > zero, square_root(squared), zero);
    return (choose((v() < zero) == (line.dz < zero), side, -side) - line.along) / line.h;
  }
};

template <typename Real>
Real distance_along(const AxisLine<Real>& line, const Real& r, const Real& z) {
  const DistanceAlong<Real> distance{line, r, z};
  return distance.by_height_is_better() ? distance.by_height() : distance.by_radius();
}

}  // namespace catoptric::cad::meridian
