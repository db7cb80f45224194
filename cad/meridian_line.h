#pragma once

#include "base/float_traps.h"
#include "base/ray.h"
#include "cad/meridian_spans.h"

namespace catoptric::cad::meridian {

/// x + a b with the rounding of one operation, by error-free transformations.
/// @from  Dekker 1971 (product), Knuth, TAOCP vol. 2, 4.2.2 (sum)
template <typename Real>
CATOPTRIC_FORCE_INLINE Real fused(const Real& x, const Real& a, const Real& b) {
  constexpr double splitter = 134217729.0;  // 2^27 + 1
  const Real ta = splitter * a, tb = splitter * b;
  const Real a1 = ta - (ta - a), b1 = tb - (tb - b);
  const Real a2 = a - a1, b2 = b - b1;
  const Real p = a * b;
  const Real product_error = ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2;
  const Real s = x + p;
  const Real v = s - x;
  const Real sum_error = (x - (s - v)) + (p - v);
  return s + (sum_error + product_error);
}

/// A ray whose origin was moved along it to where it passes nearest to the part's centre: what remains of the
/// origin is of the part's size, however far the source is.
/// @in    Real is double, or Lanes for several rays at a time
template <typename Real>
struct NearRays {
  Real ox, oy, oz;  ///< oz from the centre
  Real dx, dy, dz;
  Real shift;  ///< distance along the given ray = shift + t

  /// The ray from (x, y, z) along (ax, ay, az).
  CATOPTRIC_FORCE_INLINE void set(const Real& x, const Real& y, const Real& z, const Real& ax, const Real& ay,
                                  const Real& az, const SpanTable& table) {
    dx = ax;
    dy = ay;
    dz = az;
    const Real zc = z - table.centre_z;
    shift = -(x * dx + y * dy + zc * dz);
    const auto far = absolute(shift) > table.size;
    ox = x + shift * dx;
    oy = y + shift * dy;
    oz = zc + shift * dz;
    if (any(far)) {
      ox = choose(far, fused(x, shift, dx), ox);
      oy = choose(far, fused(y, shift, dy), oy);
      oz = choose(far, Real(fused(z, shift, dz) - table.centre_z), oz);
    }
  }

  /// Whether the ray's line comes near enough to the part to be looked at (nothing that is no number does).
  CATOPTRIC_FORCE_INLINE auto passes(const SpanTable& table) const {
    return ox * ox + oy * oy + oz * oz <= table.reach_squared;
  }
};

/// One such ray.
struct NearRay : NearRays<double> {
  NearRay(const Ray& ray, const SpanTable& table) {
    const UntrappedFloats untrapped;  // a ray that is no number passes nothing
    const Vector3 &o = ray.origin_mm, &d = ray.direction;
    set(o.x(), o.y(), o.z(), d.x(), d.y(), d.z(), table);
  }
};

/// The line of a ray in the axis frame: what the meridian sees of it. Along the line, the distance from the
/// axis is that of a point which runs at speed `h` on a straight line passing the axis at `across`.
template <typename Real>
struct AxisLine {
  Real ox, oy, oz;  ///< oz from the part's centre
  Real dx, dy, dz;
  Real h;       ///< length of the direction's part across the axis
  Real along;   ///< component of the origin along (dx, dy)
  Real across;  ///< distance of the line from the axis
  Real level;   ///< V(Z) = h Z + level vanishes where the line at height Z is nearest to the axis
  Real skew;    ///< |dz| across
  Real scale;   ///< bound of every term of F, unsquared

  AxisLine() = default;
  CATOPTRIC_FORCE_INLINE AxisLine(const NearRays<Real>& near, const SpanTable& table)
      : ox(near.ox), oy(near.oy), oz(near.oz), dx(near.dx), dy(near.dy), dz(near.dz) {
    complete(table);
  }
  AxisLine(const Ray& ray, const NearRay& near, const SpanTable& table);

 private:
  /// From the origin and direction, which are set.
  CATOPTRIC_FORCE_INLINE void complete(const SpanTable& table) {
    const Real zero = Real(0), one = Real(1);
    const Real h_squared = dx * dx + dy * dy;
    // Below this the squares leave double's range; over the part such a ray departs by less than any
    // rounding.
    const auto axial = h_squared < Real(1e-280);
    h = choose(axial, zero, square_root(h_squared));
    const Real inverse = one / h;
    const Real ex = choose(axial, one, dx * inverse), ey = choose(axial, zero, dy * inverse);
    along = ox * ex + oy * ey;
    across = absolute(ox * ey - oy * ex);
    level = dz * along - h * oz;
    skew = absolute(dz) * across;
    scale = absolute(dz) * (Real(table.r_extent) + absolute(along) + across) +
            h * (Real(table.z_extent) + absolute(oz));
  }
};

template <typename Real>
AxisLine<Real>::AxisLine(const Ray& ray, const NearRay& near, const SpanTable& table)
    : ox(near.ox), oy(near.oy), oz(near.oz), dx(near.dx), dy(near.dy), dz(near.dz) {
  if constexpr (!std::is_same_v<Real, double>) {  // from the ray as given, without the roundings of NearRay
    const Real shift = near.shift;
    ox = Real(ray.origin_mm.x()) + shift * dx;
    oy = Real(ray.origin_mm.y()) + shift * dy;
    oz = (Real(ray.origin_mm.z()) - Real(table.centre_z)) + shift * dz;
  }
  complete(table);
}

}  // namespace catoptric::cad::meridian
