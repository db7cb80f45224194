#include "cad/detail/shape.h"

#include <fmt/format.h>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <GProp_GProps.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Precision.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>

#include "base/units.h"
#include "cad/detail/occt_curve.h"
#include "cad/detail/occt_guard.h"
#include "cad/detail/wall_section.h"

namespace catoptric::cad::detail {
namespace {

void check_extent(const Profile& profile) {
  const double extent_mm = profile.diagonal_mm();
  if (!(extent_mm >= least_cad_extent_mm && extent_mm <= greatest_cad_extent_mm))
    throw CadError(
        {fmt::format("a part of {} mm cannot become a CAD shape", extent_mm), "",
         fmt::format("CAD kernels take points 1e-7 mm apart for one, which suits parts from {} mm to {} mm",
                     least_cad_extent_mm, greatest_cad_extent_mm),
         "check the scene's unit of length, or scale the profile"});
}

/// A face on the true surface of revolution. Unlike the sweep of an edge this also takes a curve whose end on
/// the axis has a repeated pole or runs along the axis.
TopoDS_Face revolved_face(const Handle(Geom_Curve) & curve) {
  const Handle(Geom_SurfaceOfRevolution) surface = new Geom_SurfaceOfRevolution(curve, gp::OZ());
  BRepBuilderAPI_MakeFace maker(surface, 0., 2 * pi, curve->FirstParameter(), curve->LastParameter(),
                                Precision::Confusion());
  if (!maker.IsDone())
    throw CadError(
        {"the optical surface cannot be built", "",
         fmt::format("OpenCASCADE's face builder ends with error {}", static_cast<int>(maker.Error())),
         "check the profile for pieces without length"});
  return maker.Face();
}

/// A line or an arc swept to the plane, cylinder, cone, sphere or torus it makes.
TopoDS_Shape swept_face(const SectionPiece& piece) {
  const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(piece.curve, piece.first, piece.last).Edge();
  return BRepPrimAPI_MakeRevol(edge, gp::OZ()).Shape();
}

TopoDS_Shell sewn_shell(const std::vector<TopoDS_Shape>& faces) {
  BRepBuilderAPI_Sewing sewing(10 * Precision::Confusion());
  for (const TopoDS_Shape& face : faces) sewing.Add(face);
  sewing.Perform();
  const TopoDS_Shape sewn = sewing.SewedShape();
  if (sewn.IsNull() || sewn.ShapeType() != TopAbs_SHELL || sewing.NbFreeEdges() != 0)
    throw CadError({"the wall's faces do not close to a solid", "", "their edges lie apart",
                    "make the wall thinner, or export the open surface"});
  return TopoDS::Shell(sewn);
}

void check_validity(const TopoDS_Shape& shape, std::string_view what) {
  if (!BRepCheck_Analyzer(shape).IsValid())
    throw CadError({fmt::format("the {} is not valid", what), "",
                    "OpenCASCADE's check of the shape finds faults",
                    "check the profile for crossing or nearly coincident points"});
}

}  // namespace

TopoDS_Shape optical_face(const Profile& profile) {
  check_extent(profile);
  return guarded("build the optical surface", "", [&] {
    const TopoDS_Face face = revolved_face(occt_cad_curve(profile));
    check_validity(face, "optical surface");
    return TopoDS_Shape(face);
  });
}

TopoDS_Shape walled_solid(const Profile& profile, const Wall& wall) {
  check_extent(profile);
  const std::vector<SectionPiece> section = wall_section(profile, wall, wall_tolerance_mm(profile));
  return guarded("build the walled solid", "", [&] {
    std::vector<TopoDS_Shape> faces{revolved_face(occt_cad_curve(profile))};
    for (const SectionPiece& piece : section)
      faces.push_back(piece.kind == SectionPiece::Kind::spline ? revolved_face(piece.curve)
                                                               : swept_face(piece));
    TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(sewn_shell(faces)).Solid();
    if (!BRepLib::OrientClosedSolid(solid))
      throw CadError({"the walled solid has no inside", "", "its shell is open", "export the open surface"});
    check_validity(solid, "walled solid");
    return TopoDS_Shape(solid);
  });
}

TopoDS_Shape make_shape(const Profile& profile, const std::optional<Wall>& wall) {
  return wall ? walled_solid(profile, *wall) : optical_face(profile);
}

ShapeFigures measure(const TopoDS_Shape& shape) {
  return guarded("measure the shape", "", [&] {
    constexpr double relative = 1e-9;  // without it the integrals are up to 0.2 % off
    GProp_GProps surface, volume;
    BRepGProp::SurfaceProperties(shape, surface, 0.01 * relative);
    int solids = 0, faces = 0;
    for (TopExp_Explorer i(shape, TopAbs_SOLID); i.More(); i.Next()) ++solids;
    for (TopExp_Explorer i(shape, TopAbs_FACE); i.More(); i.Next()) ++faces;
    if (solids > 0) BRepGProp::VolumePropertiesGK(shape, volume, 0.1 * relative);
    return ShapeFigures{BRepCheck_Analyzer(shape).IsValid() != 0, surface.Mass(),
                        solids > 0 ? volume.Mass() : 0.0, faces};
  });
}

}  // namespace catoptric::cad::detail

namespace catoptric::cad {

ShapeFigures shape_figures(const Profile& profile, const std::optional<Wall>& wall) {
  return detail::measure(detail::make_shape(profile, wall));
}

void require_wall(const Profile& profile, const Wall& wall) {
  detail::wall_section(profile, wall, detail::wall_tolerance_mm(profile));
}

}  // namespace catoptric::cad
