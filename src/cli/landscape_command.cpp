#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cli/scene_run.h"
#include "design/csv_table.h"

namespace catoptric::cli {
namespace {

/// The landscape's variables of every iterate in a convergence.csv; its column of moves is text and left out.
design::SearchPath read_path(const std::filesystem::path& file, const std::vector<std::string>& names) {
  const design::CsvTable table = design::read_csv_table(file, {"move"});
  const std::string run = file.parent_path().filename().string();
  design::SearchPath path{run, run, {}, {}, {}};
  for (std::size_t row = 0; row < table.lines.size(); ++row) {
    std::vector<double> point;
    for (const std::string& name : names) point.push_back(design::column(table, name, file.string())[row]);
    if (path.points.empty() || path.points.back() != point) path.points.push_back(point);
  }
  return path;
}

void print_result(const design::Scene& scene, const design::Landscape& result) {
  const auto best =
      std::min_element(result.objective.begin(), result.objective.end(),
                       [](double a, double b) { return !std::isnan(a) && (std::isnan(b) || a < b); });
  const std::size_t at = static_cast<std::size_t>(best - result.objective.begin());
  const std::size_t columns = result.axes.size() > 1 ? result.axes[1].size() : 1;
  fmt::print("{} points, {:.1f} s; least {} {:.6g} at {} = {:.6g}", result.objective.size(), result.seconds,
             name(scene.search.metric), *best, result.names[0], result.axes[0][at / columns]);
  if (result.axes.size() > 1) fmt::print(", {} = {:.6g}", result.names[1], result.axes[1][at % columns]);
  fmt::print("\n");
  for (const design::SearchPath& path : result.paths)
    if (!path.ending.empty()) fmt::print("{}\n", path.ending);
}

}  // namespace

ExitCode landscape_command(const CommonOptions& options, const LandscapeOptions& more) {
  SceneRun run(options);
  const design::Scene& scene = run.scene;
  std::vector<design::SearchPath> read;
  if (scene.landscape && options.leads())
    for (const auto& file : more.paths) read.push_back(read_path(file, scene.landscape->variables));
  design::Landscape result = design::run_landscape(scene, run.control);
  if (!options.leads()) return ExitCode::done;
  std::move(read.begin(), read.end(), std::back_inserter(result.paths));
  const auto files = report::write_landscape(scene, result, run.out);
  run.line.finish();
  if (options.tells_people()) print_result(scene, result);
  run.tell_files(files);
  return ExitCode::done;
}

}  // namespace catoptric::cli
