#include "cad/detail/comparison.h"

#include <fmt/format.h>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/tolerance.h"
#include "cad/detail/occt_curve.h"
#include "cad/detail/occt_guard.h"
#include "cad/detail/shape.h"

namespace catoptric::cad::detail {
namespace {

constexpr double digits_kept_rel =
    1e-12;  // 17 digits are written; the readers multiply and divide once or twice
// OCCT's box of a cone and of the same cone as a surface of revolution differ by up to 5e-6 mm (parts of 0.03
// mm to 300 m measured); the centre of area is compared more closely.
constexpr double other_kind_box_mm = 1e-5, other_kind_box_rel = 1e-8;
constexpr double integral_rel = 1e-8;  // ten times what measure() promises

std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer i(shape, TopAbs_FACE); i.More(); i.Next()) faces.push_back(TopoDS::Face(i.Current()));
  return faces;
}

int count(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  int total = 0;
  for (TopExp_Explorer i(shape, kind); i.More(); i.Next()) ++total;
  return total;
}

bool turns_about_an_axis(GeomAbs_SurfaceType type) {
  return type == GeomAbs_Cylinder || type == GeomAbs_Cone || type == GeomAbs_Sphere || type == GeomAbs_Torus;
}

std::vector<GeomAbs_SurfaceType> surface_types(const TopoDS_Shape& shape, Keeps keeps) {
  std::vector<GeomAbs_SurfaceType> types;
  for (const TopoDS_Face& face : faces_of(shape)) {
    const GeomAbs_SurfaceType type = BRepAdaptor_Surface(face, false).GetType();
    types.push_back(keeps == Keeps::faces && turns_about_an_axis(type) ? GeomAbs_SurfaceOfRevolution : type);
  }
  std::sort(types.begin(), types.end());
  return types;
}

/// The face's surface of revolution in space, or nothing.
Handle(Geom_SurfaceOfRevolution) revolution_of(const TopoDS_Face& face) {
  Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  if (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface); !trimmed.IsNull())
    surface = trimmed->BasisSurface();
  return Handle(Geom_SurfaceOfRevolution)::DownCast(surface);
}

/// What of the generatrix of one surface is not the profile's, and by how far its poles are off.
Comparison compare_generatrix(const Handle(Geom_SurfaceOfRevolution) & surface,
                              const Handle(Geom_BSplineCurve) & expected, double tolerance_mm) {
  const gp_Ax1 axis = surface->Axis();
  const double off_axis = std::hypot(axis.Location().X(), axis.Location().Y());
  if (off_axis > tolerance_mm || std::hypot(axis.Direction().X(), axis.Direction().Y()) > digits_kept_rel)
    return {fmt::format("the axis of revolution is {} mm off or tilted", off_axis), off_axis};
  Handle(Geom_Curve) curve = surface->BasisCurve();
  while (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve)) curve = trimmed->BasisCurve();
  const auto spline = Handle(Geom_BSplineCurve)::DownCast(curve);
  const double far = std::numeric_limits<double>::infinity();
  if (spline.IsNull()) return {"the generatrix is no B-spline", far};
  if (spline->Degree() != expected->Degree())
    return {fmt::format("degree {} became {}", expected->Degree(), spline->Degree()), far};
  if (spline->NbPoles() != expected->NbPoles())
    return {fmt::format("{} control points became {}", expected->NbPoles(), spline->NbPoles()), far};
  if (spline->NbKnots() != expected->NbKnots())
    return {fmt::format("{} knots became {}", expected->NbKnots(), spline->NbKnots()), far};
  Comparison result;
  for (int i = 1; i <= expected->NbPoles(); ++i) {
    const double distance = expected->Pole(i).Distance(spline->Pole(i));
    result.largest_deviation_mm = std::max(result.largest_deviation_mm, distance);
    if (distance > tolerance_mm)
      result.loss = fmt::format("control point {} moved by {} mm", i - 1, distance);
  }
  for (int i = 1; !result.loss && i <= expected->NbPoles(); ++i) {
    const double before = expected->Weight(i) / expected->Weight(1),
                 after = spline->Weight(i) / spline->Weight(1);
    if (std::abs(after - before) > digits_kept_rel * before)
      result.loss = fmt::format("weight {} (over weight 0) was {} and became {}", i - 1, before, after);
  }
  const double range = expected->LastParameter() - expected->FirstParameter();
  for (int i = 1; !result.loss && i <= expected->NbKnots(); ++i)
    if (expected->Multiplicity(i) != spline->Multiplicity(i) ||
        std::abs(expected->Knot(i) - spline->Knot(i)) > digits_kept_rel * range)
      result.loss = fmt::format("knot {} ({} times) became {} ({} times)", expected->Knot(i),
                                expected->Multiplicity(i), spline->Knot(i), spline->Multiplicity(i));
  return result;
}

/// The best match among the faces: the optical surface.
Comparison compare_optical_surface(const TopoDS_Shape& reread, const Profile& profile, double tolerance_mm) {
  const Handle(Geom_BSplineCurve) expected = occt_cad_curve(profile);
  Comparison best{"there is no surface of revolution", std::numeric_limits<double>::infinity()};
  for (const TopoDS_Face& face : faces_of(reread)) {
    const auto surface = revolution_of(face);
    if (surface.IsNull()) continue;
    const Comparison found = compare_generatrix(surface, expected, tolerance_mm);
    if (!found.loss || found.largest_deviation_mm < best.largest_deviation_mm ||
        best.loss == "there is no surface of revolution")
      best = found;
    if (!found.loss) break;
  }
  return best;
}

gp_Pnt centre_of_area(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties, 0.01 * integral_rel);
  return properties.CentreOfMass();
}

/// The tight box takes OCCT a fifth of a study's time. Surfaces of the same kind have the same loose one, and
/// what moves a face moves it too.
std::array<double, 6> box_of(const TopoDS_Shape& shape, Keeps keeps) {
  Bnd_Box box;
  if (keeps == Keeps::everything)
    BRepBndLib::Add(shape, box, false);
  else
    BRepBndLib::AddOptimal(shape, box, false, false);
  std::array<double, 6> sides{};
  box.Get(sides[0], sides[1], sides[2], sides[3], sides[4], sides[5]);
  return sides;
}

std::string kinds(const std::vector<GeomAbs_SurfaceType>& types) {
  std::string text;
  for (const GeomAbs_SurfaceType type : types) {
    static constexpr std::array names{"plane",    "cylinder",   "cone",      "sphere", "torus", "Bezier",
                                      "B-spline", "revolution", "extrusion", "offset", "other"};
    text += fmt::format("{}{}", text.empty() ? "" : ", ", names.at(static_cast<std::size_t>(type)));
  }
  return text;
}

std::optional<std::string> compare_whole(const TopoDS_Shape& reread, const TopoDS_Shape& written,
                                         Keeps keeps) {
  const auto types_before = surface_types(written, keeps), types_after = surface_types(reread, keeps);
  if (types_before != types_after)
    return fmt::format("the faces ({}) became ({})", kinds(types_before), kinds(types_after));
  if (keeps == Keeps::everything && count(reread, TopAbs_SOLID) != count(written, TopAbs_SOLID))
    return fmt::format("{} solids became {}", count(written, TopAbs_SOLID), count(reread, TopAbs_SOLID));
  const ShapeFigures before = measure(written), after = measure(reread);
  if (!after.is_valid) return "the shape that comes back is not valid";
  if (std::abs(after.area_mm2 - before.area_mm2) > integral_rel * before.area_mm2)
    return fmt::format("the area was {} mm2 and became {} mm2", before.area_mm2, after.area_mm2);
  if (keeps == Keeps::everything &&
      std::abs(after.volume_mm3 - before.volume_mm3) > integral_rel * before.volume_mm3)
    return fmt::format("the volume was {} mm3 and became {} mm3", before.volume_mm3, after.volume_mm3);
  return std::nullopt;
}

}  // namespace

TopoDS_Face optical_face_of(const TopoDS_Shape& part, const Profile& profile) {
  const Handle(Geom_BSplineCurve) expected = occt_cad_curve(profile);
  const double tolerance_mm = Tolerance::for_scale(profile.diagonal_mm()).exchange_mm;
  for (const TopoDS_Face& face : faces_of(part))
    if (const auto surface = revolution_of(face);
        !surface.IsNull() && !compare_generatrix(surface, expected, tolerance_mm).loss)
      return face;
  throw CadError({"the optical surface is not found in the part", "", "no face has the generatrix",
                  "export the open surface"});
}

Comparison compare(const TopoDS_Shape& reread, const TopoDS_Shape& written, const Profile& profile,
                   Keeps keeps) {
  return guarded("compare what was written", "", [&] {
    const double tolerance_mm = Tolerance::for_scale(profile.diagonal_mm()).exchange_mm;
    Comparison result = compare_optical_surface(reread, profile, tolerance_mm);
    if (result.loss) return result;
    result.loss = compare_whole(reread, written, keeps);
    if (result.loss) return result;
    const double centre_mm = centre_of_area(written).Distance(centre_of_area(reread));
    if (centre_mm > integral_rel * profile.diagonal_mm())
      result.loss = fmt::format("the faces moved by {} mm", centre_mm);
    const double box_mm = keeps == Keeps::everything
                              ? tolerance_mm
                              : other_kind_box_mm + other_kind_box_rel * profile.diagonal_mm();
    const auto before = box_of(written, keeps), after = box_of(reread, keeps);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const double difference = std::abs(before[i] - after[i]);
      if (keeps == Keeps::everything)
        result.largest_deviation_mm = std::max(result.largest_deviation_mm, difference);
      if (difference > box_mm)
        result.loss =
            fmt::format("a side of the bounding box moved from {} mm to {} mm", before[i], after[i]);
    }
    return result;
  });
}

}  // namespace catoptric::cad::detail
