#include <fmt/format.h>

#include <limits>

#include "base/atomic_file.h"
#include "cli/commands.h"
#include "cli/progress_line.h"
#include "cli/stop_signal.h"
#include "cli/thread_limit.h"
#include "report/run_files.h"
#include "report/run_tables.h"

namespace catoptric::cli {
namespace {

ExitCode exit_code(optim::Ending ending) {
  switch (ending) {
    case optim::Ending::converged:
      return ExitCode::done;
    case optim::Ending::stopped:
      return ExitCode::interrupted;
    default:
      return ExitCode::unconverged;
  }
}

}  // namespace

ExitCode design_command(const CommonOptions& options) {
  const design::Scene scene = design::read_scene(options.input, options.overrides());
  const std::filesystem::path out = options.out_folder();
  prepare_output_folder(out);
  const ThreadLimit limit(scene.threads);
  ProgressLine line(options.quiet, scene.search.metric == design::Metric::rmse ? "W/m^2" : "");
  const design::RunControl control{&stop_on_signal(), [&](const design::Progress& p) { line.show(p); }};
  const design::DesignResult result = design::run_design(scene, control);
  line.show({"write", 1.0, std::numeric_limits<double>::quiet_NaN(), 0});
  const auto files = report::write_design(scene, result, out);
  line.finish();
  if (!options.quiet) {
    fmt::print("{}\n{}", result.search.sentence, report::text_table(report::summary_table(scene, result)));
    fmt::print("{} evaluations, {} photons, {:.1f} s\n", result.search.evaluations, result.photons,
               result.seconds);
    for (const std::string& note : files.notes) fmt::print("note: {}\n", note);
    fmt::print("written to {}: {}\n", out.string(), fmt::join(files.names, ", "));
  }
  return exit_code(result.search.ending);
}

ExitCode simulate_command(const CommonOptions& options) {
  const design::Scene scene = design::read_scene(options.input, options.overrides());
  const std::filesystem::path out = options.out_folder();
  prepare_output_folder(out);
  const ThreadLimit limit(scene.threads);
  ProgressLine line(options.quiet, "");
  const design::RunControl control{&stop_on_signal(), [&](const design::Progress& p) { line.show(p); }};
  const design::SimulationResult result = design::run_simulation(scene, control);
  const auto files = report::write_simulation(scene, result, out);
  line.finish();
  if (!options.quiet) {
    fmt::print("{}", report::text_table(report::simulation_table(scene, result)));
    fmt::print("{} photons, {:.1f} s\n", result.photons, result.seconds);
    for (const std::string& note : files.notes) fmt::print("note: {}\n", note);
    fmt::print("written to {}: {}\n", out.string(), fmt::join(files.names, ", "));
  }
  return ExitCode::done;
}

}  // namespace catoptric::cli
