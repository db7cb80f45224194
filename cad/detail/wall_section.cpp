#include "cad/detail/wall_section.h"

#include <fmt/format.h>
#include <GC_MakeArcOfCircle.hxx>
#include <GC_MakeSegment.hxx>
#include <GeomConvert_ApproxCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_OffsetCurve.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Precision.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Circ.hxx>

#include "base/tolerance.h"
#include "base/units.h"
#include "cad/detail/flange.h"
#include "cad/detail/occt_curve.h"
#include "cad/detail/occt_guard.h"
#include "cad/detail/section_check.h"

namespace catoptric::cad::detail {
namespace {

constexpr double wall_error_of_part = 1e-9;  // what the header of shape_figures promises

/// The generatrix between two kinks, in plain numbers.
struct SmoothPart {
  std::vector<RationalSpan> spans;
  bool is_straight() const {
    const Vector2 a = point(spans.front(), 0), b = point(spans.back(), 1);
    const Vector2 way = b - a;
    for (const RationalSpan& span : spans)
      for (std::size_t i = 0; i < span.w.size(); ++i) {
        const Vector2 offset = Vector2(span.rw[i] / span.w[i], span.zw[i] / span.w[i]) - a;
        if (std::abs(way.x() * offset.y() - way.y() * offset.x()) >
            Tolerance::for_scale(way.norm()).length_mm * way.norm())
          return false;
      }
    return true;
  }
  static Vector2 point(const RationalSpan& span, double s) {
    const MeridianPoint p = evaluate(span, s);
    return {p.r_mm, p.z_mm};
  }
};

/// Unit tangent at s.
Vector2 tangent(const RationalSpan& span, double s) {
  const MeridianPoint p = evaluate(span, s);
  return Vector2(p.dr, p.dz).normalized();
}

Vector2 left_of(const Vector2& tangent) { return {-tangent.y(), tangent.x()}; }
gp_Pnt in_space(const Vector2& point) { return {point.x(), 0., point.y()}; }

/// +1 when the outside lies to the left of the running profile: the sign of minus the integral of r dz, which
/// is the area between generatrix and axis.
double outer_side(const Profile& profile) {
  double area = 0, size = 0;
  for (const RationalSpan& span : profile.spans())
    for (int i = 0; i < 64; ++i) {
      const MeridianPoint p = evaluate(span, (i + 0.5) / 64);
      area += p.r_mm * p.dz / 64;
      size += p.r_mm * std::hypot(p.dr, p.dz) / 64;
    }
  if (std::abs(area) > 1e-9 * size) return area < 0 ? 1 : -1;  // 1e-9: a flat mirror up to its rounding
  const MeridianPoint a = evaluate(profile.spans().front(), 0), b = evaluate(profile.spans().back(), 1);
  return b.r_mm >= a.r_mm ? 1 : -1;
}

std::vector<SmoothPart> split_at_kinks(const Profile& profile) {
  std::vector<SmoothPart> parts(1);
  for (const RationalSpan& span : profile.spans()) {
    if (!parts.back().spans.empty()) {
      const auto multiplicity = std::count(profile.knots().begin(), profile.knots().end(), span.first);
      if (multiplicity >= profile.degree()) parts.emplace_back();
    }
    parts.back().spans.push_back(span);
  }
  return parts;
}

/// The arc of radius |from - centre| from `from` to `to` about `centre`, the short way.
SectionPiece arc(const Vector2& centre, const Vector2& from, const Vector2& to) {
  const Vector2 middle = centre + ((from - centre) + (to - centre)).normalized() * (from - centre).norm();
  const Handle(Geom_TrimmedCurve) curve =
      GC_MakeArcOfCircle(in_space(from), in_space(middle), in_space(to)).Value();
  return SectionPiece{SectionPiece::Kind::arc, SectionPiece::Part::back, Handle(Geom_Curve)(curve),
                      curve->FirstParameter(), curve->LastParameter()};
}

/// The parallel curve of one smooth part as a B-spline whose ends are exactly `from` and `to`.
SectionPiece parallel(const Handle(Geom_BSplineCurve) & generatrix, const SmoothPart& part, double offset_mm,
                      const Vector2& from, const Vector2& to, double tolerance_mm) {
  Handle(Geom_BSplineCurve) base = Handle(Geom_BSplineCurve)::DownCast(generatrix->Copy());
  base->Segment(part.spans.front().first, part.spans.back().last);
  const Handle(Geom_OffsetCurve) offset = new Geom_OffsetCurve(base, offset_mm, gp::DY(), true);
  const GeomConvert_ApproxCurve approximation(offset, tolerance_mm, GeomAbs_C2, 400, 8);
  if (!approximation.HasResult() || approximation.MaxError() > tolerance_mm)
    throw CadError({fmt::format("the wall's outer side is not found to {} mm", tolerance_mm), "",
                    "its parallel curve bends too sharply", "make the wall thinner or the profile smoother"});
  const Handle(Geom_BSplineCurve) curve = approximation.Curve();
  curve->SetPole(1, in_space(from));
  curve->SetPole(curve->NbPoles(), in_space(to));
  return SectionPiece{SectionPiece::Kind::spline, SectionPiece::Part::back, Handle(Geom_Curve)(curve),
                      curve->FirstParameter(), curve->LastParameter()};
}

class SectionBuilder {
 public:
  SectionBuilder(const Profile& profile, const Wall& wall, double tolerance_mm)
      : profile_(profile),
        wall_(wall),
        offset_mm_(wall.thickness_mm * outer_side(profile) * (wall.side == WallSide::outside ? 1 : -1)),
        tolerance_mm_(tolerance_mm) {}

  std::vector<SectionPiece> build() {
    const std::vector<SmoothPart> parts = split_at_kinks(profile_);
    const Handle(Geom_BSplineCurve) generatrix = occt_cad_curve(profile_);
    start_end(parts.front().spans.front(), 0);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      add_part(generatrix, parts[i]);
      if (i + 1 < parts.size()) add_joint(parts[i].spans.back(), parts[i + 1].spans.front());
    }
    start_end(parts.back().spans.back(), 1);
    if (wall_.flange) {
      const RationalSpan& last = parts.back().spans.back();
      const Vector2 along = tangent(last, 1);
      add_flange(pieces_, {SmoothPart::point(last, 1), along, std::copysign(1, offset_mm_) * left_of(along)},
                 wall_.flange->width_mm, wall_.flange->thickness_mm.value_or(wall_.thickness_mm));
    }
    return std::move(pieces_);
  }

 private:
  Vector2 outer_point(const RationalSpan& span, double s) const {
    const Vector2 outer = SmoothPart::point(span, s) + offset_mm_ * left_of(tangent(span, s));
    return std::abs(outer.x()) <= Precision::Confusion() ? Vector2(0, outer.y()) : outer;
  }

  void add_part(const Handle(Geom_BSplineCurve) & generatrix, const SmoothPart& part) {
    for (const RationalSpan& span : part.spans) check_span_offset(span, offset_mm_);
    const Vector2 from = outer_point(part.spans.front(), 0), to = outer_point(part.spans.back(), 1);
    pieces_.push_back(part.is_straight() ? straight_piece(SectionPiece::Part::back, from, to)
                                         : parallel(generatrix, part, offset_mm_, from, to, tolerance_mm_));
  }

  void add_joint(const RationalSpan& before, const RationalSpan& after) {
    const Vector2 a = outer_point(before, 1), b = outer_point(after, 0);
    if ((b - a).norm() <= Precision::Confusion()) return;
    const Vector2 in = tangent(before, 1), out = tangent(after, 0);
    const double turn = in.x() * out.y() - in.y() * out.x();
    const Vector2 kink = SmoothPart::point(after, 0);
    if (turn * offset_mm_ > 0)
      throw CadError({"the wall overlaps itself at a kink of the profile",
                      fmt::format("r = {} mm, z = {} mm", kink.x(), kink.y()),
                      "the profile bends towards the wall there without a radius",
                      "round the kink by more than the wall's thickness, or put the wall on the other side"});
    pieces_.push_back(arc(kink, a, b));
  }

  /// Closes the section at the profile's start (s = 0) or end (s = 1).
  void start_end(const RationalSpan& span, double s) {
    const Vector2 inner = SmoothPart::point(span, s), outer = outer_point(span, s);
    if (inner.x() > Precision::Confusion()) {
      pieces_.push_back(
          straight_piece(SectionPiece::Part::edge, s == 0 ? inner : outer, s == 0 ? outer : inner));
      return;
    }
    if (outer.x() == 0) return;
    if (outer.x() < 0)
      throw CadError({"the wall crosses the axis at a pointed vertex",
                      fmt::format("r = 0, z = {} mm", inner.y()), "there is no room for it inside the point",
                      "put the wall on the other side or make the profile meet the axis at a right angle"});
    const Vector2 tangent_here = tangent(span, s);
    const double up = offset_mm_ * tangent_here.x() > 0 ? 1 : -1;
    const Vector2 on_axis(0, inner.y() + up * std::abs(offset_mm_));
    pieces_.push_back(s == 0 ? arc({0, inner.y()}, on_axis, outer) : arc({0, inner.y()}, outer, on_axis));
  }

  const Profile& profile_;
  const Wall& wall_;
  double offset_mm_;
  double tolerance_mm_;
  std::vector<SectionPiece> pieces_;
};

void check_wall(const Profile& profile, const Wall& wall) {
  if (!std::isfinite(wall.thickness_mm) || wall.thickness_mm <= 10 * Precision::Confusion())
    throw CadError(
        {fmt::format("a wall of {} mm cannot be built", wall.thickness_mm), "",
         "it must be a finite thickness above 1e-6 mm, ten times what the kernel takes for one point",
         "make the wall thicker, or export the open surface"});
  const Vector2 a = SmoothPart::point(profile.spans().front(), 0);
  const Vector2 b = SmoothPart::point(profile.spans().back(), 1);
  const bool both_on_axis = a.x() <= Precision::Confusion() && b.x() <= Precision::Confusion();
  if (both_on_axis || (a - b).norm() <= Precision::Confusion())
    throw CadError({"a closed mirror cannot be given a wall", "", "no light could enter or leave it",
                    "open the profile, or export the surface without a wall"});
}

/// A flange stands outside, at the wider end, which is where the generatrix ends.
void check_flange(const Profile& profile, const Wall& wall) {
  if (!wall.flange) return;
  if (wall.side == WallSide::inside)
    throw CadError({"a wall inside the mirror cannot have a flange", "", "the flange stands outside the rim",
                    "put the wall outside, or leave the flange out"});
  if (profile.at(profile.first_parameter()).r_mm >= profile.at(profile.last_parameter()).r_mm)
    throw CadError({"there is no rim for the flange", "",
                    "it stands where the generatrix ends, which is not its wider end here",
                    "list the control points from the apex to the rim, or leave the flange out"});
}

/// OCCT's parallel curve needs a tangent at every point of the generatrix.
void check_ends_run(const Profile& profile) {
  for (const RationalSpan& span : profile.spans())
    for (const double s : {0.0, 1.0}) {
      const MeridianPoint p = evaluate(span, s);
      if (std::hypot(p.dr, p.dz) <= Precision::Confusion())
        throw CadError({"the profile cannot be given a wall",
                        fmt::format("r = {} mm, z = {} mm", p.r_mm, p.z_mm),
                        "two control points coincide there, so that the curve has no derivative",
                        "move the two points apart, or export the open surface"});
    }
}

}  // namespace

SectionPiece straight_piece(SectionPiece::Part part, const Vector2& from, const Vector2& to) {
  const Handle(Geom_TrimmedCurve) curve = GC_MakeSegment(in_space(from), in_space(to)).Value();
  return SectionPiece{SectionPiece::Kind::line, part, Handle(Geom_Curve)(curve), curve->FirstParameter(),
                      curve->LastParameter()};
}

double wall_tolerance_mm(const Profile& profile) {
  return std::max(wall_error_of_part * profile.diagonal_mm(), Precision::Confusion());
}

std::vector<SectionPiece> wall_section(const Profile& profile, const Wall& wall, double tolerance_mm) {
  check_wall(profile, wall);
  check_flange(profile, wall);
  check_ends_run(profile);
  return guarded("build the wall", "", [&] {
    std::vector<SectionPiece> pieces = SectionBuilder(profile, wall, tolerance_mm).build();
    check_section_is_simple(profile, pieces);
    return pieces;
  });
}

}  // namespace catoptric::cad::detail
