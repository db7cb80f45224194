#include "report/run_files.h"

#include <nlohmann/json.hpp>

#include "design/designed_scene.h"
#include "design/illustration.h"
#include "report/result_json.h"
#include "report/run_figures.h"
#include "report/run_folder.h"
#include "report/run_page.h"

namespace catoptric::report {
namespace {

std::vector<NamedFigure> with_illustration(const design::Scene& scene, std::vector<NamedFigure> figures,
                                           const design::Illustration& illustration) {
  if (illustration.intensity) figures.push_back(polar_picture(*illustration.intensity));
  if (illustration.landscape) figures.push_back(landscape_picture(scene, *illustration.landscape));
  return figures;
}

}  // namespace

std::uint64_t room_for(const design::Scene& scene) {
  // Measured: 7.3 MB of plots, page and exchange files, and 140 bytes a sample.
  constexpr std::uint64_t files = 13'000'000, of_a_sample = 300;
  std::uint64_t samples = scene.samples;
  for (const design::FieldSpec& field : scene.fields) samples += field.samples;
  return files + of_a_sample * samples;
}

WrittenFiles write_design(const design::Scene& scene, const design::DesignResult& result,
                          const std::filesystem::path& path) {
  RunFolder folder(path);
  folder.text("scene.toml", design::scene_text(scene));
  folder.text("result.json", json_text(result_json(scene, result)));
  folder.table("irradiance.csv", irradiance_table(scene, result.target, result.best.judgement));
  folder.table("generatrix.csv",
               generatrix_table(scene, {{"start", result.start.profile}, {"result", result.best.profile}}));
  folder.table("convergence.csv", convergence_table(scene, result));
  folder.text("designed.toml", design::designed_text(scene, result.best));
  folder.exchange("reflector.step", result.best.profile, scene.export_options);
  folder.exchange("reflector.igs", result.best.profile, scene.export_options);
  folder.exchange("reflector.dxf", result.best.profile, scene.export_options);
  const design::Illustration illustration = design::illustrate(scene, result);
  const auto figures = folder.draw_all(with_illustration(scene, design_figures(scene, result), illustration));
  folder.text("report.html", design_page(scene, result, illustration, figures));
  return folder.take();
}

WrittenFiles write_simulation(const design::Scene& scene, const design::SimulationResult& result,
                              const std::filesystem::path& path) {
  RunFolder folder(path);
  folder.text("scene.toml", design::scene_text(scene));
  folder.text("result.json", json_text(result_json(scene, result)));
  folder.table("irradiance.csv", irradiance_table(scene, result.target, result.mirror.judgement));
  folder.table("generatrix.csv", generatrix_table(scene, {{"mirror", result.mirror.profile}}));
  const design::Illustration illustration = design::illustrate(scene);
  const auto figures =
      folder.draw_all(with_illustration(scene, simulation_figures(scene, result), illustration));
  folder.text("report.html", simulation_page(scene, result, illustration, figures));
  return folder.take();
}

WrittenFiles write_landscape(const design::Scene& scene, const design::Landscape& landscape,
                             const std::filesystem::path& path) {
  RunFolder folder(path);
  folder.table("landscape.csv", landscape_table(scene, landscape));
  if (!landscape.paths.empty()) folder.table("paths.csv", paths_table(scene, landscape));
  folder.draw_all(landscape_figures(scene, landscape));
  return folder.take();
}

WrittenFiles write_study(const design::Study& study, const std::vector<StudyRow>& rows, double seconds,
                         const std::filesystem::path& path) {
  RunFolder folder(path);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const StudyRow& row : rows) {
    nlohmann::ordered_json entry = {{"name", row.run.name}};
    if (row.designed) entry.update(result_json(*row.scene, *row.designed));
    if (row.simulated) entry.update(result_json(*row.scene, *row.simulated));
    if (!row.error.empty()) entry["error"] = row.error;
    for (const auto& [key, value] : row.run.reference) entry["reference"][key] = value;
    list.push_back(std::move(entry));
  }
  const Table table = study_table(rows);
  folder.text("study.json", json_text(list));
  folder.table("study.csv", table);
  folder.text("report.html", study_page(study, rows, seconds, folder.draw_all(study_figures(rows))));
  return folder.take();
}

}  // namespace catoptric::report
