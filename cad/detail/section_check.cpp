#include "cad/detail/section_check.h"

#include <fmt/format.h>

#include <Precision.hxx>
#include <gp_Pnt.hxx>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/tolerance.h"

namespace catoptric::cad::detail {
namespace {

[[noreturn]] void refuse_wall(std::string what, const Vector2& at) {
  throw CadError({std::move(what), fmt::format("r = {} mm, z = {} mm", at.x(), at.y()),
                  "the wall is thicker than the profile allows there",
                  "make the wall thinner, put it on the other side, or export the open surface"});
}

double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Whether two segments have a point in common, touching included.
bool meet(const Vector2& a, const Vector2& b, const Vector2& c, const Vector2& d) {
  if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) || std::max(c.x(), d.x()) < std::min(a.x(), b.x()) ||
      std::max(a.y(), b.y()) < std::min(c.y(), d.y()) || std::max(c.y(), d.y()) < std::min(a.y(), b.y()))
    return false;
  const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
  return c_side * d_side <= 0 && a_side * b_side <= 0;
}

/// The section's outline: along the generatrix and back over the wall.
std::vector<Vector2> outline(const Profile& profile, const std::vector<SectionPiece>& pieces) {
  constexpr int steps = 64;
  std::vector<Vector2> points;
  const auto add = [&](const Vector2& point) {
    if (points.empty() || (points.back() - point).norm() > Precision::Confusion()) points.push_back(point);
  };
  for (const RationalSpan& span : profile.spans())
    for (int i = 0; i <= steps; ++i) {
      const MeridianPoint p = evaluate(span, static_cast<double>(i) / steps);
      add({p.r_mm, p.z_mm});
    }
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
    const int count = piece->kind == SectionPiece::Kind::line ? 1 : steps;
    for (int i = count; i >= 0; --i) {
      const double u = piece->first + (piece->last - piece->first) * i / count;
      const gp_Pnt p = piece->curve->Value(u);
      add({p.X(), p.Z()});
    }
  }
  return points;
}

}  // namespace

void check_span_offset(const RationalSpan& span, double offset_mm) {
  constexpr int steps = 128;
  for (int i = 0; i <= steps; ++i) {
    const MeridianPoint p = evaluate(span, static_cast<double>(i) / steps);
    const double speed = std::hypot(p.dr, p.dz);
    if (!(speed > 0)) continue;
    const double curvature = (p.dr * p.ddz - p.dz * p.ddr) / (speed * speed * speed);
    if (curvature * offset_mm >= 1) refuse_wall("the wall folds", {p.r_mm, p.z_mm});
    const bool inside = i > 0 && i < steps;
    if (inside && p.r_mm - offset_mm * p.dz / speed < 0)
      refuse_wall("the wall crosses the axis", {p.r_mm, p.z_mm});
  }
}

void check_section_is_simple(const Profile& profile, const std::vector<SectionPiece>& pieces) {
  const std::vector<Vector2> points = outline(profile, pieces);
  const std::size_t segments = points.size() - 1;
  const bool closed =
      (points.front() - points.back()).norm() <= Tolerance::for_scale(profile.diagonal_mm()).exchange_mm;
  for (std::size_t i = 0; i + 2 < segments + 1; ++i)
    for (std::size_t j = i + 2; j < segments; ++j) {
      if (closed && i == 0 && j + 1 == segments) continue;
      if (meet(points[i], points[i + 1], points[j], points[j + 1]))
        refuse_wall("the wall meets the mirror or itself", points[i]);
    }
}

}  // namespace catoptric::cad::detail
