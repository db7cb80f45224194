#include "cad/meridian_candidate.h"

#include <algorithm>
#include <cmath>

namespace catoptric::cad::meridian {
namespace {

/// Unit vector across the axis in the azimuth of the hit. On the axis itself every azimuth is right for the
/// point; the ray's own meridian plane is chosen, which decides the normal at a cone's tip.
Vector2 azimuth(const NearRay& near, double t, double r) {
  const Vector2 at(near.ox + t * near.dx, near.oy + t * near.dy);
  const double distance = std::sqrt(at.x() * at.x() + at.y() * at.y());
  if (r > 0 && distance > 0) return at * (1 / distance);
  const double h = std::hypot(near.dx, near.dy);
  return h > 0 ? Vector2(near.dx / h, near.dy / h) : Vector2(1, 0);
}

/// Direction of the tangent in the meridian plane, by Horner's rule as for the curve.
Vector2 tangent(const SpanForm& span, double s) {
  const bool lower = s <= 0.5;
  const double q = lower ? s / (1 - s) : (1 - s) / s;
  const int degree = span.tangent_degree;
  Vector2 value(0, 0);
  for (int i = degree; i >= 0; --i) {
    const std::size_t at = static_cast<std::size_t>(lower ? i : degree - i);
    value = value * q + Vector2(span.tangent_r[at], span.tangent_z[at]);
  }
  return value;
}

}  // namespace

Hit make_hit(const SpanTable& table, const NearRay& near, const Candidate& candidate) {
  const SpanForm& span = table.spans[static_cast<std::size_t>(candidate.span)];
  const Vector2 e = azimuth(near, candidate.t, candidate.r);
  Vector2 along = tangent(span, candidate.s);
  // A cusp inside a span has no tangent either; beside it there is one.
  constexpr double beside = 0x1p-26;
  if (along.squaredNorm() == 0) along = tangent(span, candidate.s + (candidate.s < 0.5 ? beside : -beside));
  Vector3 normal(along.y() * e.x(), along.y() * e.y(), -along.x());
  normal *= 1 / std::sqrt(normal.x() * normal.x() + normal.y() * normal.y() + normal.z() * normal.z());
  if (normal.x() * near.dx + normal.y() * near.dy + normal.z() * near.dz > 0) normal = -normal;
  return {near.shift + candidate.t,
          Vector3(candidate.r * e.x(), candidate.r * e.y(), candidate.z + table.centre_z), normal,
          std::min(span.first + candidate.s * span.width, span.last)};
}

}  // namespace catoptric::cad::meridian
