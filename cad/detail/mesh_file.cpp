#include <BRepBuilderAPI_Transform.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Message_ProgressRange.hxx>
#include <Poly_Triangulation.hxx>
#include <RWGltf_CafWriter.hxx>
#include <RWMesh_CoordinateSystem.hxx>
#include <StlAPI_Writer.hxx>
#include <TColStd_IndexedDataMapOfStringString.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "cad/detail/exchange_file.h"
#include "cad/detail/occt_guard.h"
#include "cad/detail/shape_facets.h"

namespace catoptric::cad::detail {
namespace {

constexpr double angle_rad = 0.2;  // of a facet against the surface: smooth to the eye on small features too

}  // namespace

int put_facets(const TopoDS_Shape& shape, double chord) {
  const BRepMesh_IncrementalMesh mesher(shape, chord, false, angle_rad, false);
  if (!mesher.IsDone())
    throw CadError(
        {"the surface cannot be meshed", "", "OpenCASCADE's mesher stopped", "try a larger chord tolerance"});
  int triangles = 0;
  for (TopExp_Explorer i(shape, TopAbs_FACE); i.More(); i.Next()) {
    TopLoc_Location place;
    const auto facets = BRep_Tool::Triangulation(TopoDS::Face(i.Current()), place);
    if (facets.IsNull() || facets->NbTriangles() == 0)
      throw CadError({"a face came out of the mesher empty", "", "it is smaller than the chord tolerance",
                      "try a smaller chord tolerance"});
    triangles += facets->NbTriangles();
  }
  return triangles;
}

namespace {

/// The shape in another unit of length, on its own geometry.
TopoDS_Shape scaled(const TopoDS_Shape& shape, double factor) {
  gp_Trsf to_unit;
  to_unit.SetScale(gp_Pnt(0., 0., 0.), factor);
  return BRepBuilderAPI_Transform(shape, to_unit, true).Shape();
}

}  // namespace

int write_stl(const TopoDS_Shape& shape, const std::filesystem::path& path, LengthUnit unit,
              double chord_mm) {
  ExchangeSession session;
  return guarded("write the STL file", path.string(), [&] {
    const double factor = 1 / millimetres_per(unit);
    const TopoDS_Shape part = scaled(shape, factor);
    const int triangles = put_facets(part, factor * chord_mm);
    StlAPI_Writer writer;
    writer.ASCIIMode() = false;
    if (!writer.Write(part, path.c_str()))
      throw IoError({"cannot write the STL file", path.string(), "", "check the free space"});
    return triangles;
  });
}

int write_glb(const TopoDS_Shape& shape, const std::filesystem::path& path, const FileLabels& labels,
              double chord_mm) {
  ExchangeSession session;
  return guarded("write the GLB file", path.string(), [&] {
    const TopoDS_Shape part = scaled(shape, 1);  // a copy: the triangles stay off the shape that was given
    const int triangles = put_facets(part, chord_mm);
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
    const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
    TDataStd_Name::Set(shapes->AddShape(part, false), labels.product.c_str());
    RWGltf_CafWriter writer(path.c_str(), true);
    writer.ChangeCoordinateSystemConverter().SetInputLengthUnit(0.001);  // metres in one mm
    writer.ChangeCoordinateSystemConverter().SetInputCoordinateSystem(RWMesh_CoordinateSystem_Zup);
    TColStd_IndexedDataMapOfStringString notes;
    notes.Add("Authors", labels.author.c_str());
    const bool written = writer.Perform(document, notes, Message_ProgressRange());
    XCAFApp_Application::GetApplication()->Close(document);
    if (!written) throw IoError({"cannot write the GLB file", path.string(), "", "check the free space"});
    return triangles;
  });
}

}  // namespace catoptric::cad::detail
