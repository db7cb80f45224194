#include "cad/detail/section_drawing.h"

#include <GCPnts_UniformDeflection.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <gp_Pnt.hxx>

#include <cmath>

#include "base/units.h"
#include "cad/detail/occt_curve.h"
#include "cad/detail/occt_guard.h"
#include "cad/detail/wall_section.h"

namespace catoptric::cad::detail {
namespace {

constexpr double polyline_chord_rel = 1e-6;  // a ten-thousandth of a millimetre in 100: finer than any tool

// LibreCAD 2.2 leaves out splines of higher degree without a word, and the weights of all.
constexpr int greatest_degree_read_by_all = 3;

std::string layer_of(SectionPiece::Part part) {
  return part == SectionPiece::Part::back ? "BACK" : part == SectionPiece::Part::edge ? "EDGE" : "FLANGE";
}

class Draughtsman {
 public:
  Draughtsman(LengthUnit unit, DxfCurves curves, double chord_mm)
      : unit_mm_(millimetres_per(unit)), curves_(curves), chord_mm_(chord_mm) {
    drawing_.unit = unit;
  }

  void line(std::string layer, const gp_Pnt& from, const gp_Pnt& to) {
    drawing_.curves.push_back({DrawnCurve::Kind::line, std::move(layer), {at(from), at(to)}});
  }

  void arc(std::string layer, const SectionPiece& piece) {
    const gp_Circ circle = GeomAdaptor_Curve(piece.curve).Circle();
    const Vector2 centre = at(circle.Location());
    const auto seen = [&](double u) { return Vector2(at(piece.curve->Value(u)) - centre); };
    Vector2 from = seen(piece.first), to = seen(piece.last);
    const Vector2 middle = seen(0.5 * (piece.first + piece.last));
    if (from.x() * middle.y() - from.y() * middle.x() < 0) std::swap(from, to);
    DrawnCurve curve{DrawnCurve::Kind::arc, std::move(layer), {centre}};
    curve.radius = circle.Radius() / unit_mm_;
    curve.first_deg = degrees(from);
    curve.last_deg = degrees(to);
    drawing_.curves.push_back(std::move(curve));
  }

  void spline(std::string layer, const Handle(Geom_BSplineCurve) & spline) {
    const bool read_by_all = !spline->IsRational() && spline->Degree() <= greatest_degree_read_by_all;
    const bool exact = curves_ == DxfCurves::splines || (curves_ == DxfCurves::automatic && read_by_all);
    DrawnCurve curve{exact ? DrawnCurve::Kind::spline : DrawnCurve::Kind::polyline, std::move(layer), {}};
    if (spline->Degree() == 1) curve.kind = DrawnCurve::Kind::polyline;  // exactly
    if (exact || spline->Degree() == 1) {
      for (int i = 1; i <= spline->NbPoles(); ++i) curve.points.push_back(at(spline->Pole(i)));
      if (curve.kind == DrawnCurve::Kind::spline) {
        curve.degree = spline->Degree();
        for (const double knot : spline->KnotSequence()) curve.knots.push_back(knot + 0.0);
        for (int i = 1; spline->IsRational() && i <= spline->NbPoles(); ++i)
          curve.weights.push_back(spline->Weight(i));
      }
    } else {
      curve.points = vertices(spline);
      drawing_.chord_mm = chord_mm_;
    }
    drawing_.curves.push_back(std::move(curve));
  }

  Drawing take() { return std::move(drawing_); }

 private:
  /// No minus zero, which is another text.
  Vector2 at(const gp_Pnt& point) const { return {point.X() / unit_mm_ + 0.0, point.Z() / unit_mm_ + 0.0}; }

  static double degrees(const Vector2& way) { return std::atan2(way.y(), way.x()) * 180 / pi + 0.0; }

  /// Span by span, so that no chord cuts a kink off.
  std::vector<Vector2> vertices(const Handle(Geom_BSplineCurve) & spline) const {
    std::vector<Vector2> points{at(spline->StartPoint())};
    for (int i = 1; i < spline->NbKnots(); ++i) {
      const GeomAdaptor_Curve span(spline, spline->Knot(i), spline->Knot(i + 1));
      const GCPnts_UniformDeflection steps(span, chord_mm_, true);
      if (!steps.IsDone())
        throw CadError({"the generatrix does not become a polyline", "", "OpenCASCADE finds no points on it",
                        "write splines instead"});
      for (int j = 2; j <= steps.NbPoints(); ++j) points.push_back(at(spline->Value(steps.Parameter(j))));
    }
    return points;
  }

  double unit_mm_;
  DxfCurves curves_;
  double chord_mm_;
  Drawing drawing_;
};

}  // namespace

Drawing section_drawing(const Profile& profile, const std::optional<Wall>& wall, LengthUnit unit,
                        DxfCurves curves) {
  const std::vector<SectionPiece> pieces =
      wall ? wall_section(profile, *wall, wall_tolerance_mm(profile)) : std::vector<SectionPiece>();
  return guarded("draw the section", "", [&] {
    Draughtsman draughtsman(unit, curves, polyline_chord_rel * profile.diagonal_mm());
    draughtsman.spline("OPTICAL", occt_cad_curve(profile));
    for (const SectionPiece& piece : pieces) {
      const std::string layer = layer_of(piece.part);
      if (piece.kind == SectionPiece::Kind::line)
        draughtsman.line(layer, piece.curve->Value(piece.first), piece.curve->Value(piece.last));
      else if (piece.kind == SectionPiece::Kind::arc)
        draughtsman.arc(layer, piece);
      else
        draughtsman.spline(layer, Handle(Geom_BSplineCurve)::DownCast(piece.curve));
    }
    const double beyond_mm = 0.05 * profile.diagonal_mm() + (wall ? wall->thickness_mm : 0);
    draughtsman.line("AXIS", gp_Pnt(0., 0., profile.z_min_mm() - beyond_mm),
                     gp_Pnt(0., 0., profile.z_max_mm() + beyond_mm));
    return draughtsman.take();
  });
}

std::optional<std::string> difference(const Drawing& written, const Drawing& reread) {
  if (written.unit != reread.unit) return "the unit of length is another one";
  if (written.curves.size() != reread.curves.size())
    return std::to_string(written.curves.size()) + " curves became " + std::to_string(reread.curves.size());
  for (std::size_t i = 0; i < written.curves.size(); ++i)
    if (!(written.curves[i] == reread.curves[i]))
      return "a curve on layer " + written.curves[i].layer + " is another one";
  return std::nullopt;
}

}  // namespace catoptric::cad::detail
