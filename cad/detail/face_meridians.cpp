#include <fmt/format.h>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <GeomConvert.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

#include <cmath>

#include "base/errors.h"
#include "base/units.h"
#include "cad/detail/curve_source.h"

namespace catoptric::cad::detail {
namespace {

struct Revolved {
  std::string kind;
  gp_Ax1 axis;
};

std::optional<Revolved> revolved(const Handle(Geom_Surface) & surface) {
  if (const auto s = Handle(Geom_SurfaceOfRevolution)::DownCast(surface); !s.IsNull())
    return Revolved{"surface of revolution", s->Axis()};
  if (const auto s = Handle(Geom_CylindricalSurface)::DownCast(surface); !s.IsNull())
    return Revolved{"cylinder", s->Axis()};
  if (const auto s = Handle(Geom_ConicalSurface)::DownCast(surface); !s.IsNull())
    return Revolved{"cone", s->Axis()};
  if (const auto s = Handle(Geom_SphericalSurface)::DownCast(surface); !s.IsNull())
    return Revolved{"sphere", s->Axis()};
  if (const auto s = Handle(Geom_ToroidalSurface)::DownCast(surface); !s.IsNull())
    return Revolved{"torus", s->Axis()};
  return std::nullopt;
}

/// The face's meridian. A surface of revolution hands out its own generatrix, so that no digit changes.
SourceCurve meridian(const Handle(Geom_Surface) & surface, double u, double v_first, double v_last) {
  const auto revolution = Handle(Geom_SurfaceOfRevolution)::DownCast(surface);
  const Handle(Geom_Curve) whole = revolution.IsNull() ? surface->UIso(u) : revolution->BasisCurve();
  return joined_curve(pieces_of(BRepBuilderAPI_MakeEdge(whole, v_first, v_last).Edge()));
}

bool same_axis(const gp_Ax1& a, const gp_Ax1& b, double tolerance_mm) {
  return a.IsParallel(b, import_rel) && gp_Lin(b).Distance(a.Location()) <= tolerance_mm;
}

/// Whether two meridians are the same but for a turn about their common axis.
bool same_meridian(const SourceCurve& a, const SourceCurve& b) {
  const gp_Lin axis(*a.axis);
  const double size = a.curve->StartPoint().Distance(a.curve->EndPoint()) +
                      axis.Distance(a.curve->StartPoint()) + axis.Distance(a.curve->EndPoint());
  const double tolerance_mm = import_rel * size;
  if (!same_axis(*a.axis, *b.axis, tolerance_mm)) return false;
  const auto agrees = [&](bool reversed) {
    for (int i = 0; i <= 8; ++i) {
      const auto at = [i](const Handle(Geom_BSplineCurve) & curve, bool backwards) {
        const double share = (backwards ? 8 - i : i) / 8.0;
        return curve->Value(curve->FirstParameter() +
                            share * (curve->LastParameter() - curve->FirstParameter()));
      };
      const gp_Pnt p = at(a.curve, false), q = at(b.curve, reversed);
      const double along = gp_Vec(p, q).Dot(gp_Vec(axis.Direction()));
      if (std::abs(axis.Distance(p) - axis.Distance(q)) > tolerance_mm || std::abs(along) > tolerance_mm)
        return false;
    }
    return true;
  };
  return agrees(false) || agrees(true);
}

void add_face(const TopoDS_Face& face, CurveSource& source) {
  Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  if (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface); !trimmed.IsNull())
    surface = trimmed->BasisSurface();
  const auto found = revolved(surface);
  if (!found) return;
  source.face_axes.push_back(found->axis);
  double u_first = 0, u_last = 0, v_first = 0, v_last = 0;
  BRepTools::UVBounds(face, u_first, u_last, v_first, v_last);
  SourceCurve curve = meridian(surface, u_first, v_first, v_last);
  curve.axis = found->axis;
  curve.is_line = false;  // it has an axis, so it cannot be one
  curve.description = fmt::format("meridian of a {} ({}), {:.4g} degrees about the axis", found->kind,
                                  curve.description, (u_last - u_first) * 180 / pi);
  for (const SourceCurve& known : source.curves)
    if (known.axis && same_meridian(known, curve)) return;
  source.curves.push_back(std::move(curve));
}

}  // namespace

void add_faces_of_revolution(const TopoDS_Shape& shape, CurveSource& source) {
  for (TopExp_Explorer i(shape, TopAbs_FACE); i.More(); i.Next()) {
    try {
      add_face(TopoDS::Face(i.Current()), source);
    } catch (const CadError& error) {
      source.refused.push_back({"a face", error.parts()});
    }
  }
}

}  // namespace catoptric::cad::detail
