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
#include "cad/detail/section_drawing.h"
#include "cad/detail/shape.h"

namespace catoptric::cad {
namespace {

constexpr double least_chord_rel = 1e-6;  // some 10 million facets
constexpr double greatest_chord_rel = 0.1;

/// What an export works on.
struct Job {
  FileFormat format;
  const Profile& profile;
  const ExportOptions& options;
  detail::FileLabels labels;
  TopoDS_Shape shape;
  detail::Drawing drawing;  ///< of a DXF
};

bool has_part_labels(const Job& job) {
  return job.format == FileFormat::step && job.options.schema == StepSchema::ap242;
}

detail::Comparison compare_with_file(const Job& job, const std::filesystem::path& path) {
  switch (job.format) {
    case FileFormat::step: {
      detail::Comparison found = detail::compare(detail::read_step(path), job.shape, job.profile);
      if (!found.loss && has_part_labels(job))
        found.loss = detail::part_loss(path, job.shape, job.profile, job.labels);
      return found;
    }
    case FileFormat::iges:
      return detail::compare(
          detail::read_iges(path), job.shape, job.profile,
          job.options.iges_mode == IgesMode::faces ? detail::Keeps::faces : detail::Keeps::everything);
    case FileFormat::dxf:
      return {detail::difference(job.drawing, detail::read_dxf(path)), 0};
    default:
      return detail::compare(detail::read_brep(path), job.shape, job.profile);
  }
}

/// Reads the file back and stops unless it holds what was written.
/// @out   largest deviation, mm
double verify(const Job& job, const PendingFile& pending, const std::filesystem::path& final_path) {
  detail::Comparison comparison;
  try {
    comparison = compare_with_file(job, pending.temporary_path());
  } catch (const CadError& error) {
    comparison.loss = "it cannot be read back (" + error.parts().what + ")";
  }
  if (comparison.loss)
    throw CadError({fmt::format("the {} file would not hold the mirror as it is", name_of(job.format)),
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
  if (!options.wall && !options.material.name.empty())
    throw InputError(
        {fmt::format("the material \"{}\" cannot be given to an open surface", options.material.name), "",
         "only a solid is made of something", "give the mirror a wall, or leave it out"});
}

/// Writes to `path`, which is not yet the final one.
void write(const Job& job, const std::filesystem::path& path, ExportReport& report) {
  const ExportOptions& options = job.options;
  switch (job.format) {
    case FileFormat::step:
      if (has_part_labels(job))
        return detail::write_step_part(job.shape, job.profile, path, job.labels, options.unit);
      return detail::write_step(job.shape, path, job.labels, options.unit, options.schema);
    case FileFormat::iges:
      return detail::write_iges(job.shape, path, job.labels, options.unit, options.iges_mode);
    case FileFormat::brep:
      return detail::write_brep(job.shape, path);
    case FileFormat::stl:
      report.chord_mm = options.chord_tolerance_rel * job.profile.diagonal_mm();
      report.triangle_count = detail::write_stl(job.shape, path, options.unit, report.chord_mm);
      return;
    case FileFormat::glb:
      report.chord_mm = options.chord_tolerance_rel * job.profile.diagonal_mm();
      report.triangle_count = detail::write_glb(job.shape, path, job.labels, report.chord_mm);
      return;
    case FileFormat::dxf:
      report.chord_mm = job.drawing.chord_mm;
      return detail::write_dxf(job.drawing, path, job.labels.product);
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
  if (extension == ".dxf") return FileFormat::dxf;
  throw CadError({fmt::format("no export format has the extension \"{}\"", extension), path.string(), "",
                  "end the name in .step, .stp, .igs, .iges, .brep, .stl, .glb or .dxf"});
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
    case FileFormat::dxf:
      return "DXF";
  }
  return "";
}

ExportReport export_reflector(const Profile& profile, const std::filesystem::path& path,
                              const ExportOptions& options) {
  ExportReport report{format_of(path), {}, 0, 0};
  check_options(options);
  Job job{report.format,
          profile,
          options,
          detail::make_labels(path, options),
          detail::make_shape(profile, options.wall),
          {}};
  if (job.format == FileFormat::dxf)
    job.drawing = detail::section_drawing(profile, options.wall, options.unit, options.dxf_curves);
  report.figures = detail::measure(job.shape);
  PendingFile pending(path);
  write(job, pending.temporary_path(), report);
  pending.require_room();
  if (job.format != FileFormat::stl && job.format != FileFormat::glb)
    report.largest_deviation_mm = verify(job, pending, path);
  pending.commit();
  return report;
}

}  // namespace catoptric::cad
