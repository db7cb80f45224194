#pragma once

#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <optional>
#include <string>

#include "cad/export.h"

namespace catoptric::cad::detail {

/// What an exchange file says about itself, ready to be written.
struct FileLabels {
  std::string file_name;
  std::string product, author, organization;
  std::string time_stamp;  ///< ISO 8601, never empty
  PartMaterial material = {};
};

/// Labels from the options, checked.
/// @fails InputError when a text is not printable ASCII or the time stamp has another form
FileLabels make_labels(const std::filesystem::path& path, const ExportOptions& options);

/// OCCT's word for a unit of length: "MM", "CM", "M" or "INCH".
const char* unit_name(LengthUnit unit);

/// Writers and readers of exact formats. Shapes are in mm. Reals are printed with 17 digits.
/// @fails CadError when OCCT refuses, IoError when the file cannot be written
void write_step(const TopoDS_Shape& shape, const std::filesystem::path& path, const FileLabels& labels,
                LengthUnit unit, StepSchema schema);
/// STEP of AP242 with what it can say of a part: names of the part and its faces, colours, material.
void write_step_part(const TopoDS_Shape& shape, const Profile& profile, const std::filesystem::path& path,
                     const FileLabels& labels, LengthUnit unit);
void write_iges(const TopoDS_Shape& shape, const std::filesystem::path& path, const FileLabels& labels,
                LengthUnit unit, IgesMode mode);
void write_brep(const TopoDS_Shape& shape, const std::filesystem::path& path);

/// The file's shape in mm.
/// @fails CadError when there is no such file, it is not of that format or holds no shape
TopoDS_Shape read_step(const std::filesystem::path& path);
TopoDS_Shape read_iges(const std::filesystem::path& path);
TopoDS_Shape read_brep(const std::filesystem::path& path);

/// What of names, colours and material is missing in a file of write_step_part, in words, or nothing.
std::optional<std::string> part_loss(const std::filesystem::path& path, const TopoDS_Shape& written,
                                     const Profile& profile, const FileLabels& labels);

/// Writers of meshes; the shape is meshed within chord_mm.
/// @out   number of triangles
int write_stl(const TopoDS_Shape& shape, const std::filesystem::path& path, LengthUnit unit, double chord_mm);
int write_glb(const TopoDS_Shape& shape, const std::filesystem::path& path, const FileLabels& labels,
              double chord_mm);

}  // namespace catoptric::cad::detail
