#include <fmt/format.h>

#include <algorithm>

#include "base/atomic_file.h"
#include "cad/export.h"
#include "cli/commands.h"
#include "cli/json_lines.h"
#include "design/run.h"
#include "report/run_files.h"

namespace catoptric::cli {
namespace {

struct Format {
  const char* name;
  const char* file;
};

constexpr Format formats[] = {{"step", "reflector.step"}, {"iges", "reflector.igs"},
                              {"brep", "reflector.brep"}, {"stl", "reflector.stl"},
                              {"glb", "reflector.glb"},   {"dxf", "reflector.dxf"}};

/// What the reader saw that read the file back; of a drawing and of a mesh the part that it shows.
std::string description(const cad::ExportReport& report, const cad::PartMaterial& material) {
  std::string text = fmt::format("{} face{}, area {:.6g} mm^2", report.figures.face_count,
                                 report.figures.face_count == 1 ? "" : "s", report.figures.area_mm2);
  if (report.figures.volume_mm3 > 0) text += fmt::format(", volume {:.6g} mm^3", report.figures.volume_mm3);
  if (report.figures.volume_mm3 > 0 && material.density_kg_per_m3)
    text += fmt::format(", mass {:.6g} kg", report.figures.volume_mm3 * 1e-9 * *material.density_kg_per_m3);
  if (report.triangle_count > 0)
    return text +
           fmt::format("; {} triangles, chord error {:.3g} mm", report.triangle_count, report.chord_mm);
  if (report.chord_mm > 0) text += fmt::format("; polylines, chord error {:.3g} mm", report.chord_mm);
  return text + fmt::format("; read back, largest deviation {:.3g} mm", report.largest_deviation_mm);
}

}  // namespace

std::vector<std::string> export_format_names() {
  std::vector<std::string> names;
  for (const Format& format : formats) names.emplace_back(format.name);
  return names;
}

ExitCode export_command(const CommonOptions& options, const ExportCommandOptions& more) {
  const design::Scene scene = design::read_scene(options.input, options.overrides());
  const Profile profile = design::start_profile(scene);
  const std::filesystem::path out = options.out_folder();
  prepare_output_folder(out, report::room_for(scene));
  std::vector<std::string> wanted = more.formats;
  if (wanted.empty()) wanted = {"step", "iges"};
  std::vector<std::string> lines;
  report::WrittenFiles files;
  for (const Format& format : formats) {
    if (std::find(wanted.begin(), wanted.end(), format.name) == wanted.end()) continue;
    const cad::ExportReport report = cad::export_reflector(profile, out / format.file, scene.export_options);
    lines.push_back(fmt::format("{}: {}", (out / format.file).string(),
                                description(report, scene.export_options.material)));
    files.names.emplace_back(format.file);
  }
  if (options.json) json_written(files, out);
  if (options.tells_people())
    for (const std::string& line : lines) fmt::print("{}\n", line);
  return ExitCode::done;
}

}  // namespace catoptric::cli
