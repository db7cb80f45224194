#include "cad/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "base/atomic_file.h"
#include "base/float_traps.h"
#include "cad/detail/comparison.h"
#include "cad/detail/exchange_file.h"
#include "cad/detail/shape.h"

namespace catoptric::cad {
namespace {

constexpr double least_chord_rel = 1e-6;  // some 10 million facets
constexpr double greatest_chord_rel = 0.1;

detail::Comparison compare_with_file(FileFormat format, IgesMode mode, const std::filesystem::path& path,
                                     const TopoDS_Shape& shape, const Profile& profile) {
  switch (format) {
    case FileFormat::step:
      return detail::compare(detail::read_step(path), shape, profile);
    case FileFormat::iges:
      return detail::compare(detail::read_iges(path), shape, profile,
                             mode == IgesMode::faces ? detail::Keeps::faces : detail::Keeps::everything);
    default:
      return detail::compare(detail::read_brep(path), shape, profile);
  }
}

/// Reads the file back and stops unless it holds what was written.
/// @out   largest deviation, mm
double verify(FileFormat format, const ExportOptions& options, const PendingFile& pending,
              const std::filesystem::path& final_path, const TopoDS_Shape& shape, const Profile& profile) {
  detail::Comparison comparison;
  try {
    comparison = compare_with_file(format, options.iges_mode, pending.temporary_path(), shape, profile);
  } catch (const CadError& error) {
    comparison.loss = "it cannot be read back (" + error.parts().what + ")";
  }
  if (comparison.loss)
    throw CadError({fmt::format("the {} file would not hold the mirror as it is", name_of(format)),
                    final_path.string(), *comparison.loss,
                    "another format or schema, or the open surface; nothing was written"});
  return comparison.largest_deviation_mm;
}

void check_options(const ExportOptions& options) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (!(options.chord_tolerance_rel >= least_chord_rel && options.chord_tolerance_rel <= greatest_chord_rel))
    throw InputError(
        {fmt::format("chord tolerance {} is out of range", options.chord_tolerance_rel), "",
         fmt::format("it lies between {} and {} of the part's extent", least_chord_rel, greatest_chord_rel),
         "leave it out"});
}

/// Writes to `path`, which is not yet the final one.
void write(FileFormat format, const TopoDS_Shape& shape, const std::filesystem::path& path,
           const detail::FileLabels& labels, const ExportOptions& options, double chord_mm,
           ExportReport& report) {
  switch (format) {
    case FileFormat::step:
      return detail::write_step(shape, path, labels, options.unit, options.schema);
    case FileFormat::iges:
      return detail::write_iges(shape, path, labels, options.unit, options.iges_mode);
    case FileFormat::brep:
      return detail::write_brep(shape, path);
    case FileFormat::stl:
      report.triangle_count = detail::write_stl(shape, path, options.unit, chord_mm);
      return;
    case FileFormat::glb:
      report.triangle_count = detail::write_glb(shape, path, labels, chord_mm);
      return;
  }
}

}  // namespace

FileFormat format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".step" || extension == ".stp") return FileFormat::step;
  if (extension == ".igs" || extension == ".iges") return FileFormat::iges;
  if (extension == ".brep" || extension == ".brp") return FileFormat::brep;
  if (extension == ".stl") return FileFormat::stl;
  if (extension == ".glb") return FileFormat::glb;
  throw CadError({fmt::format("no export format has the extension \"{}\"", extension), path.string(), "",
                  "end the name in .step, .stp, .igs, .iges, .brep, .stl or .glb"});
}

std::string_view name_of(FileFormat format) {
  switch (format) {
    case FileFormat::step:
      return "STEP";
    case FileFormat::iges:
      return "IGES";
    case FileFormat::brep:
      return "BREP";
    case FileFormat::stl:
      return "STL";
    case FileFormat::glb:
      return "GLB";
  }
  return "";
}

ExportReport export_reflector(const Profile& profile, const std::filesystem::path& path,
                              const ExportOptions& options) {
  ExportReport report{format_of(path), {}, 0, 0};
  check_options(options);
  const detail::FileLabels labels = detail::make_labels(path, options);
  const TopoDS_Shape shape = detail::make_shape(profile, options.wall);
  report.figures = detail::measure(shape);
  PendingFile pending(path);
  write(report.format, shape, pending.temporary_path(), labels, options,
        options.chord_tolerance_rel * profile.diagonal_mm(), report);
  pending.require_room();
  if (report.format != FileFormat::stl && report.format != FileFormat::glb)
    report.largest_deviation_mm = verify(report.format, options, pending, path, shape, profile);
  pending.commit();
  return report;
}

}  // namespace catoptric::cad
