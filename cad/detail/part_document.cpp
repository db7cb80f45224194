#include "cad/detail/part_document.h"

#include <fmt/format.h>
#include <Quantity_Color.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Face.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <cmath>

#include "cad/detail/ascii.h"
#include "cad/detail/comparison.h"
#include "cad/detail/occt_guard.h"

namespace catoptric::cad::detail {
namespace {

// OCCT takes a document's densities for g/cm^3.
constexpr double document_density_per_kg_per_m3 = 1e-3;

Quantity_Color optical_color() { return {0.62, 0.78, 0.94, Quantity_TOC_sRGB}; }
Quantity_Color body_color() { return {0.55, 0.55, 0.57, Quantity_TOC_sRGB}; }

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
  const TCollection_AsciiString text(name->Get());
  return text.ToCString();
}

void put_material(const PartDocument& document, const TDF_Label& part, const PartMaterial& material) {
  if (material.name.empty()) return;
  XCAFDoc_DocumentTool::MaterialTool(document.get()->Main())
      ->SetMaterial(part, ascii(material.name), ascii(""),
                    material.density_kg_per_m3.value_or(0) * document_density_per_kg_per_m3,
                    ascii("density measure"), ascii("POSITIVE_RATIO_MEASURE"));
}

std::optional<std::string> color_difference(const PartDocument& document, const TopoDS_Shape& shape,
                                            const Quantity_Color& expected, const char* what) {
  const auto colors = XCAFDoc_DocumentTool::ColorTool(document.get()->Main());
  Quantity_Color found;
  if (!colors->GetColor(shape, XCAFDoc_ColorSurf, found) && !colors->GetColor(shape, XCAFDoc_ColorGen, found))
    return fmt::format("the color of the {} is missing", what);
  constexpr double half_step = 0.5 / 255;
  double before[3], after[3];
  expected.Values(before[0], before[1], before[2], Quantity_TOC_sRGB);
  found.Values(after[0], after[1], after[2], Quantity_TOC_sRGB);
  for (int i = 0; i < 3; ++i)
    if (std::abs(before[i] - after[i]) > half_step)
      return fmt::format("the color of the {} was ({}, {}, {}) and became ({}, {}, {})", what, before[0],
                         before[1], before[2], after[0], after[1], after[2]);
  return std::nullopt;
}

std::optional<std::string> material_difference(const PartDocument& document, const PartMaterial& expected) {
  TDF_LabelSequence materials;
  const auto tool = XCAFDoc_DocumentTool::MaterialTool(document.get()->Main());
  tool->GetMaterialLabels(materials);
  if (expected.name.empty())
    return materials.IsEmpty() ? std::nullopt : std::optional<std::string>("a material came from nowhere");
  if (materials.Length() != 1) return fmt::format("1 material became {}", materials.Length());
  Handle(TCollection_HAsciiString) name, description, density_name, density_type;
  double density = 0;
  if (!tool->GetMaterial(materials.First(), name, description, density, density_name, density_type) ||
      name.IsNull() || expected.name != name->ToCString())
    return fmt::format("the material {} is missing", expected.name);
  const double wanted = expected.density_kg_per_m3.value_or(0) * document_density_per_kg_per_m3;
  if (std::abs(density - wanted) > 1e-12 * wanted)
    return fmt::format("the density was {} g/cm^3 and became {}", wanted, density);
  return std::nullopt;
}

}  // namespace

PartDocument::PartDocument() { XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document_); }

PartDocument::~PartDocument() { XCAFApp_Application::GetApplication()->Close(document_); }

void put_part(const PartDocument& document, const TopoDS_Shape& shape, const Profile& profile,
              const FileLabels& labels) {
  const TopoDS_Face optical = optical_face_of(shape, profile);
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document.get()->Main());
  const auto colors = XCAFDoc_DocumentTool::ColorTool(document.get()->Main());
  const TDF_Label part = shapes->AddShape(shape, false);
  TDataStd_Name::Set(part, labels.product.c_str());
  put_material(document, part, labels.material);
  if (shape.IsSame(optical)) return colors->SetColor(part, optical_color(), XCAFDoc_ColorSurf);
  colors->SetColor(part, body_color(), XCAFDoc_ColorSurf);
  for (TopExp_Explorer i(shape, TopAbs_FACE); i.More(); i.Next()) {
    const bool is_optical = i.Current().IsSame(optical);
    const TDF_Label face = shapes->AddSubShape(part, i.Current());
    TDataStd_Name::Set(face, is_optical ? optical_surface_name : body_face_name);
    if (is_optical) colors->SetColor(face, optical_color(), XCAFDoc_ColorSurf);
  }
}

std::optional<std::string> difference(const PartDocument& document, const TopoDS_Shape& written,
                                      const Profile& profile, const FileLabels& labels) {
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document.get()->Main());
  TDF_LabelSequence parts;
  shapes->GetFreeShapes(parts);
  if (parts.Length() != 1) return fmt::format("1 part became {}", parts.Length());
  const TDF_Label part = parts.First();
  if (name_of(part) != labels.product)
    return fmt::format("the part \"{}\" became \"{}\"", labels.product, name_of(part));
  if (const auto loss = material_difference(document, labels.material)) return loss;
  const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(part);
  const TopoDS_Face optical = optical_face_of(shape, profile);
  if (const auto loss = color_difference(document, optical, optical_color(), optical_surface_name))
    return loss;
  if (written.ShapeType() == TopAbs_FACE) return std::nullopt;
  for (TopExp_Explorer i(shape, TopAbs_FACE); i.More(); i.Next()) {
    const char* expected = i.Current().IsSame(optical) ? optical_surface_name : body_face_name;
    TDF_Label face;
    if (!shapes->FindSubShape(part, i.Current(), face) || name_of(face) != expected)
      return fmt::format("the name of a face, {}, is missing", expected);
  }
  return color_difference(document, shape, body_color(), body_face_name);
}

}  // namespace catoptric::cad::detail
