#pragma once

#include "base/ray.h"
#include "cad/meridian_spans.h"

namespace catoptric::cad::meridian {

/// x + a b with the rounding of one operation, by error-free transformations.
/// @from  Dekker 1971 (product), Knuth, TAOCP vol. 2, 4.2.2 (sum)
inline double fused(double x, double a, double b) {
  constexpr double splitter = 134217729.0;  // 2^27 + 1
  const double ta = splitter * a, tb = splitter * b;
  const double a1 = ta - (ta - a), b1 = tb - (tb - b);
  const double a2 = a - a1, b2 = b - b1;
  const double p = a * b;
  const double product_error = ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2;
  const double s = x + p;
  const double v = s - x;
  const double sum_error = (x - (s - v)) + (p - v);
  return s + (sum_error + product_error);
}

/// A ray whose origin was moved along it to where it passes nearest to the part's centre: what remains of the
/// origin is of the part's size, however far the source is.
struct NearRay {
  double ox, oy, oz;  ///< oz from the centre
  double dx, dy, dz;
  double shift;  ///< distance along the given ray = shift + t

  NearRay(const Ray& ray, const SpanTable& table) : dx(ray.direction.x()), dy(ray.direction.y()) {
    dz = ray.direction.z();
    const double x = ray.origin_mm.x(), y = ray.origin_mm.y(), z = ray.origin_mm.z() - table.centre_z;
    shift = -(x * dx + y * dy + z * dz);
    if (std::abs(shift) > table.size) {
      ox = fused(x, shift, dx);
      oy = fused(y, shift, dy);
      oz = fused(ray.origin_mm.z(), shift, dz) - table.centre_z;
    } else {
      ox = x + shift * dx;
      oy = y + shift * dy;
      oz = z + shift * dz;
    }
  }

  /// Whether the ray's line comes near enough to the part to be looked at (nothing that is no number does).
  bool passes(const SpanTable& table) const { return ox * ox + oy * oy + oz * oz <= table.reach_squared; }
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

  AxisLine(const Ray& ray, const NearRay& near, const SpanTable& table);
};

template <typename Real>
AxisLine<Real>::AxisLine(const Ray& ray, const NearRay& near, const SpanTable& table)
    : dx(near.dx), dy(near.dy), dz(near.dz) {
  if constexpr (std::is_same_v<Real, double>) {
    ox = near.ox;
    oy = near.oy;
    oz = near.oz;
  } else {  // from the ray as given, without the roundings of NearRay
    const Real shift = near.shift;
    ox = Real(ray.origin_mm.x()) + shift * dx;
    oy = Real(ray.origin_mm.y()) + shift * dy;
    oz = (Real(ray.origin_mm.z()) - Real(table.centre_z)) + shift * dz;
  }
  const Real h_squared = dx * dx + dy * dy;
  // Below this the squares leave double's range; over the part such a ray departs by less than any rounding.
  const bool axial = h_squared < Real(1e-280);
  h = axial ? Real(0) : square_root(h_squared);
  const Real ex = axial ? Real(1) : dx / h, ey = axial ? Real(0) : dy / h;
  along = ox * ex + oy * ey;
  across = absolute(ox * ey - oy * ex);
  level = dz * along - h * oz;
  skew = absolute(dz) * across;
  scale = absolute(dz) * (Real(table.r_extent) + absolute(along) + across) +
          h * (Real(table.z_extent) + absolute(oz));
}

}  // namespace catoptric::cad::meridian
