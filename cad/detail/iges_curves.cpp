#include <fmt/format.h>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESGeom_CompositeCurve.hxx>
#include <IGESGeom_ConicArc.hxx>
#include <IGESGeom_SurfaceOfRevolution.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TCollection_HAsciiString.hxx>
#include <gp_GTrsf.hxx>
#include <gp_Pnt2d.hxx>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "cad/detail/conic_arc.h"
#include "cad/detail/curve_source.h"
#include "cad/detail/exchange_check.h"
#include "cad/detail/occt_guard.h"

namespace catoptric::cad::detail {
namespace {

constexpr int deepest_composite = 20;  // a file may have a composite inside itself

struct CurveType {
  int number;
  std::string_view name;
};

constexpr std::array curve_types{CurveType{100, "circular arc"},
                                 CurveType{102, "composite curve"},
                                 CurveType{104, "conic arc"},
                                 CurveType{106, "polyline"},
                                 CurveType{110, "line"},
                                 CurveType{112, "parametric spline"},
                                 CurveType{126, "rational B-spline"},
                                 CurveType{130, "offset curve"}};

std::optional<CurveType> curve_type(const Handle(IGESData_IGESEntity) & entity) {
  const auto type = std::find_if(curve_types.begin(), curve_types.end(),
                                 [&](const CurveType& each) { return each.number == entity->TypeNumber(); });
  if (type == curve_types.end()) return std::nullopt;
  return *type;
}

/// Stands on its own: not a part of another entity, no curve in a surface's parameters, not hidden.
bool is_free(const Handle(IGESData_IGESEntity) & entity) {
  const int subordinate = entity->SubordinateStatus();
  return (subordinate == 0 || subordinate == 2) && entity->UseFlag() != 5 && entity->BlankStatus() == 0;
}

/// A conic by its own coefficients and ends.
CurvePiece conic_piece(const Handle(IGESGeom_ConicArc) & conic, double unit_mm) {
  std::array<double, 6> coefficients{};
  conic->Equation(coefficients[0], coefficients[1], coefficients[2], coefficients[3], coefficients[4],
                  coefficients[5]);
  const gp_Pnt2d start = conic->StartPoint(), end = conic->EndPoint();
  const ConicArc arc = conic_arc(coefficients, {start.X(), start.Y()}, {end.X(), end.Y()});
  const gp_GTrsf place = conic->CompoundLocation();
  const int count = static_cast<int>(arc.points.size());
  TColgp_Array1OfPnt poles(1, count);
  TColStd_Array1OfReal weights(1, count);
  for (int i = 1; i <= count; ++i) {
    const auto index = static_cast<std::size_t>(i - 1);
    gp_XYZ point(arc.points[index].x(), arc.points[index].y(), conic->ZPlane());
    place.Transforms(point);
    poles(i) = gp_Pnt(point * unit_mm);
    weights(i) = arc.weights[index];
  }
  const int pieces = (count - 1) / 2;
  TColStd_Array1OfReal knots(1, pieces + 1);
  TColStd_Array1OfInteger multiplicities(1, pieces + 1);
  for (int i = 0; i <= pieces; ++i) {
    knots(i + 1) = i;
    multiplicities(i + 1) = i == 0 || i == pieces ? 3 : 2;
  }
  return {new Geom_BSplineCurve(poles, weights, knots, multiplicities, 2), arc.kind, 0};
}

/// The pieces of a curve entity; a composite's from its parts, one by one, for the sake of conics in it.
std::vector<CurvePiece> pieces_of_entity(IGESControl_Reader& reader,
                                         const Handle(IGESData_IGESEntity) & entity, double unit_mm,
                                         int depth) {
  if (const auto conic = Handle(IGESGeom_ConicArc)::DownCast(entity); !conic.IsNull())
    return {conic_piece(conic, unit_mm)};
  if (const auto composite = Handle(IGESGeom_CompositeCurve)::DownCast(entity); !composite.IsNull()) {
    if (depth > deepest_composite)
      throw CadError({"a composite curve contains itself", "", "", "export it again"});
    std::vector<CurvePiece> pieces;
    for (int i = 1; i <= composite->NbCurves(); ++i) {
      if (composite->Curve(i).IsNull()) continue;
      if (composite->Curve(i)->TypeNumber() == 116) continue;  // a point between two curves is allowed
      for (CurvePiece& piece : pieces_of_entity(reader, composite->Curve(i), unit_mm, depth + 1))
        pieces.push_back(std::move(piece));
    }
    return pieces;
  }
  const int before = reader.NbShapes();
  if (!reader.TransferEntity(entity) || reader.NbShapes() <= before)
    throw CadError({"OpenCASCADE makes no curve of it", "", "", "export it as a B-spline (IGES 126)"});
  return pieces_of(reader.Shape(reader.NbShapes()));
}

void add_curve(IGESControl_Reader& reader, const Handle(IGESData_IGESEntity) & entity, const CurveType& type,
               CurveSource& source) {
  const std::string name =
      fmt::format("{} (IGES {} at D{})", type.name, type.number, reader.IGESModel()->DNum(entity));
  try {
    guarded("convert the " + name, "", [&] {
      const double unit_mm = reader.IGESModel()->GlobalSection().UnitValue();
      SourceCurve curve = joined_curve(pieces_of_entity(reader, entity, unit_mm, 0));
      curve.description = fmt::format("{}: {}", name, curve.description);
      curve.is_line = curve.is_line && type.number == 110;
      source.curves.push_back(std::move(curve));
    });
  } catch (const CadError& error) {
    source.refused.push_back({name, error.parts()});
  }
}

bool has_conic(const Handle(IGESData_IGESEntity) & curve, int depth = 0) {
  if (curve.IsNull() || depth > deepest_composite) return false;
  if (curve->TypeNumber() == 104) return true;
  const auto composite = Handle(IGESGeom_CompositeCurve)::DownCast(curve);
  if (composite.IsNull()) return false;
  for (int i = 1; i <= composite->NbCurves(); ++i)
    if (has_conic(composite->Curve(i), depth + 1)) return true;
  return false;
}

/// Meridians and axes of the file's faces. A surface of revolution on a conic arc (104) is refused: OCCT
/// reads most of those conics wrong.
void add_faces(const std::filesystem::path& file, const Handle(IGESData_IGESModel) & model,
               CurveSource& source) {
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto surface = Handle(IGESGeom_SurfaceOfRevolution)::DownCast(model->Entity(i));
    if (!surface.IsNull() && has_conic(surface->Generatrix())) {
      source.refused.push_back(
          {fmt::format("surface of revolution (IGES 120 at D{})", model->DNum(surface)),
           {"its generatrix is a conic arc (IGES 104)", "", "OpenCASCADE reads most of those wrong",
            "export it as a B-spline, or as STEP"}});
      return;
    }
  }
  IGESControl_Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone || reader.NbRootsForTransfer() < 1) return;
  for (int i = 1; i <= reader.NbRootsForTransfer(); ++i) {
    // Free curves were done already, and some conics keep OCCT busy for ever.
    const auto root = Handle(IGESData_IGESEntity)::DownCast(reader.RootForTransfer(i));
    if (!root.IsNull() && !curve_type(root)) reader.TransferOneRoot(i);
  }
  if (reader.NbShapes() > 0) add_faces_of_revolution(reader.OneShape(), source);
}

std::string unit_words(const IGESData_GlobalSection& global) {
  const Handle(TCollection_HAsciiString) name = global.UnitName();
  return fmt::format("IGES file in {} ({} mm each)", name.IsNull() ? "its own unit" : name->ToCString(),
                     global.UnitValue());
}

}  // namespace

CurveSource read_iges_curves(const std::filesystem::path& file) {
  check_iges_layout(file);
  ExchangeSession session;
  session.set("xstep.cascade.unit", "MM");
  session.set("read.iges.bspline.continuity", 0);  // or curves with kinks are cut up or smoothed
  return guarded("read the IGES file", file.string(), [&] {
    IGESControl_Reader reader;
    // ReadFile also says "done" of files without a single entity.
    if (reader.ReadFile(file.c_str()) != IFSelect_RetDone || reader.IGESModel().IsNull() ||
        reader.IGESModel()->NbEntities() < 1)
      throw CadError({"this is no IGES file with geometry", file.string(), "", "export it again"});
    CurveSource source;
    const Handle(IGESData_IGESModel) model = reader.IGESModel();
    source.unit = unit_words(model->GlobalSection());
    for (int i = 1; i <= model->NbEntities(); ++i) {
      const Handle(IGESData_IGESEntity) entity = model->Entity(i);
      if (const auto type = curve_type(entity); type && is_free(entity))
        add_curve(reader, entity, *type, source);
    }
    CurveSource from_faces;
    add_faces(file, model, from_faces);
    source.add_meridians(std::move(from_faces));
    return source;
  });
}

}  // namespace catoptric::cad::detail
