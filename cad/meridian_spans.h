#pragma once

#include <array>
#include <vector>

#include "base/profile.h"
#include "cad/meridian_real.h"

namespace catoptric::cad::meridian {

inline constexpr int most_degree = 9;
inline constexpr std::size_t most_poles = most_degree + 1;
/// Coefficients of the degree 2p - 1 polynomials that give the tangent's direction.
inline constexpr std::size_t most_tangent = 2 * most_degree;

/// A piece of the generatrix in homogeneous coordinates, z measured from the part's centre.
template <typename Real>
struct Homogeneous {
  std::array<Real, most_poles> rw, zw, w;
};

/// A piece of a span, [lo, lo + width] of its parameter s; the ends are exact.
template <typename Real>
struct Piece {
  Homogeneous<Real> curve;
  Real lo, width;
  int span;
  bool free_lo, free_hi;  ///< whether the generatrix ends there
};

inline Piece<double> rounded(const Piece<Quad>& piece) {
  Piece<double> result{{},
                       static_cast<double>(piece.lo),
                       static_cast<double>(piece.width),
                       piece.span,
                       piece.free_lo,
                       piece.free_hi};
  for (std::size_t i = 0; i < most_poles; ++i) {
    result.curve.rw[i] = static_cast<double>(piece.curve.rw[i]);
    result.curve.zw[i] = static_cast<double>(piece.curve.zw[i]);
    result.curve.w[i] = static_cast<double>(piece.curve.w[i]);
  }
  return result;
}

/// Halves a piece by de Casteljau. The common end is the same number in both.
template <typename Real>
void halve(const Piece<Real>& piece, int degree, Piece<Real>& left, Piece<Real>& right) {
  right = piece;
  const auto split = [degree](std::array<Real, most_poles>& high, std::array<Real, most_poles>& low) {
    const std::size_t count = static_cast<std::size_t>(degree) + 1;
    low[0] = high[0];
    for (std::size_t level = 1; level < count; ++level) {
      for (std::size_t i = 0; i + level < count; ++i) high[i] = (high[i] + high[i + 1]) * Real(0.5);
      low[level] = high[0];
    }
  };
  split(right.curve.rw, left.curve.rw);
  split(right.curve.zw, left.curve.zw);
  split(right.curve.w, left.curve.w);
  left.span = piece.span;
  left.lo = piece.lo;
  left.width = right.width = piece.width * Real(0.5);
  right.lo = piece.lo + left.width;
  left.free_lo = piece.free_lo;
  left.free_hi = right.free_lo = false;
  right.free_hi = piece.free_hi;
}

/// One span ready for evaluation by Horner's rule in s / (1 - s), or (1 - s) / s in the upper half: the
/// coefficients carry the binomials.
/// @from  Schumaker & Volk 1986 (a Bernstein polynomial evaluated without de Casteljau)
struct SpanForm {
  double first, last, width;  ///< of the profile's parameter
  std::array<double, most_poles> rw, zw, w;
  /// Direction of the tangent, (r' w^2, z' w^2) up to a positive factor, with its zeros at the ends divided
  /// out: repeated poles leave the parametrization without a speed there but not the curve without a tangent.
  std::array<double, most_tangent> tangent_r, tangent_z;
  int tangent_degree;
  bool is_point;  ///< all poles coincide: no surface
};

/// A point of the generatrix on the axis, at an end of a span.
struct AxisPoint {
  int span;
  double s, z;
};

/// Everything about a profile that the solver wants precomputed. Immutable.
struct SpanTable {
  explicit SpanTable(const Profile& profile);

  int degree;
  double centre_z;       ///< z is measured from here
  double reach_squared;  ///< square of the radius, round the centre, that holds the part (with some slack)
  double r_extent, z_extent;  ///< largest |r| and |z - centre_z| of the poles
  double size;                ///< r_extent + z_extent
  std::vector<SpanForm> spans;
  std::vector<AxisPoint> axis_points;
  bool axis_points_known;               ///< whether the control polygon shows that there are no others
  std::vector<Piece<Quad>> exact;       ///< the spans themselves
  std::vector<Piece<Quad>> exact_half;  ///< each cut in two
};

}  // namespace catoptric::cad::meridian
