#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/atomic_file.h"
#include "cli/commands.h"
#include "cli/progress_line.h"
#include "cli/stop_signal.h"
#include "design/csv_table.h"
#include "design/thread_limit.h"
#include "report/run_files.h"

namespace catoptric::cli {
namespace {

/// The landscape's variables of every iterate in a convergence.csv; its column of moves is text and left out.
report::SearchPath read_path(const std::filesystem::path& file, const std::vector<std::string>& names) {
  const design::CsvTable table = design::read_csv_table(file, {"move"});
  report::SearchPath path{file.parent_path().filename().string(), {}};
  for (std::size_t row = 0; row < table.lines.size(); ++row) {
    std::vector<double> point;
    for (const std::string& name : names) point.push_back(design::column(table, name, file.string())[row]);
    if (path.points.empty() || path.points.back() != point) path.points.push_back(point);
  }
  return path;
}

}  // namespace

ExitCode landscape_command(const CommonOptions& options, const LandscapeOptions& more) {
  const design::Scene scene = design::read_scene(options.input, options.overrides());
  std::vector<report::SearchPath> paths;
  if (scene.landscape)
    for (const auto& file : more.paths) paths.push_back(read_path(file, scene.landscape->variables));
  const std::filesystem::path out = options.out_folder();
  prepare_output_folder(out);
  const design::ThreadLimit limit(scene.threads);
  ProgressLine line(options.quiet, scene.search.metric == design::Metric::rmse ? "W/m^2" : "");
  const design::RunControl control{&stop_on_signal(), [&](const design::Progress& p) { line.show(p); }};
  const design::Landscape result = design::run_landscape(scene, control);
  const auto files = report::write_landscape(scene, result, paths, out);
  line.finish();
  if (options.quiet) return ExitCode::done;
  const auto best =
      std::min_element(result.objective.begin(), result.objective.end(),
                       [](double a, double b) { return !std::isnan(a) && (std::isnan(b) || a < b); });
  const std::size_t at = static_cast<std::size_t>(best - result.objective.begin());
  const std::size_t columns = result.axes.size() > 1 ? result.axes[1].size() : 1;
  fmt::print("{} points, {:.1f} s; least {} {:.6g} at {} = {:.6g}", result.objective.size(), result.seconds,
             name(scene.search.metric), *best, result.names[0], result.axes[0][at / columns]);
  if (result.axes.size() > 1) fmt::print(", {} = {:.6g}", result.names[1], result.axes[1][at % columns]);
  fmt::print("\n");
  for (const std::string& note : files.notes) fmt::print("note: {}\n", note);
  fmt::print("written to {}: {}\n", out.string(), fmt::join(files.names, ", "));
  return ExitCode::done;
}

}  // namespace catoptric::cli
