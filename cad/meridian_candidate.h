#pragma once

#include <vector>

#include "cad/meridian_line.h"
#include "cad/meridian_refine.h"

namespace catoptric::cad::meridian {

/// A hit before it is dressed as one.
struct Candidate {
  double t;  ///< along the line, from the near origin
  double s;  ///< on the span
  double r, z;
  int span;
};

/// About t, where the line (a NearRays or an AxisLine) is nearest to the surface point at (r, z) that lies in
/// the azimuth of t.
template <typename Line, typename Real>
CATOPTRIC_FORCE_INLINE Real nearest_along(const Line& near, const Real& t, const Real& r, const Real& z) {
  const Real x = near.ox + t * near.dx, y = near.oy + t * near.dy;
  const Real distance = square_root(x * x + y * y), zero = Real(0);
  const Real share = choose(distance > zero, r / distance, zero);
  return (share * x - near.ox) * near.dx + (share * y - near.oy) * near.dy + (z - near.oz) * near.dz;
}

/// A hit at about t.
inline Candidate make_candidate(const NearRay& near, double t, double s, double r, double z, int span) {
  return {nearest_along(near, t, r, z), s, r, z, span};
}

/// Point, normal and distance of a hit.
Hit make_hit(const SpanTable& table, const NearRay& near, const Candidate& candidate);

/// All hits of a line in 113-bit arithmetic, for rays that double cannot decide: tangents, near misses of the
/// vertex, ends met exactly. A touch that even this arithmetic does not resolve counts as one hit; a line
/// that lies in the surface (along a cone's side, in a flat part) meets it nowhere.
/// @cost  0.01 to 4 ms
void find_exactly(const SpanTable& table, const Ray& ray, const NearRay& near, std::vector<Candidate>& out);

/// A line steeper than this across the axis is taken as horizontal: over the part its height changes by less
/// than half a rounding.
inline constexpr double horizontal_slope = 0x1p-54;

}  // namespace catoptric::cad::meridian
