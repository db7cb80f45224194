#include <fmt/format.h>

#include <limits>

#include "base/atomic_file.h"
#include "cli/commands.h"
#include "cli/progress_line.h"
#include "cli/stop_signal.h"
#include "design/thread_limit.h"
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

/// An accuracy that was asked for and not proven is an unconverged end: files are there, and say so.
ExitCode with_accuracy(ExitCode code, const design::Judgement& judgement) {
  if (code != ExitCode::done || !judgement.accuracy || judgement.accuracy->proven) return code;
  return stop_on_signal() ? ExitCode::interrupted : ExitCode::unconverged;
}

void print_accuracy(const design::Judgement& judgement) {
  if (judgement.accuracy) fmt::print("{}\n", judgement.accuracy->sentence);
}

}  // namespace

ExitCode design_command(const CommonOptions& options) {
  const design::Scene scene = design::read_scene(options.input, options.overrides());
  const std::filesystem::path out = options.out_folder();
  prepare_output_folder(out);
  const design::ThreadLimit limit(scene.threads);
  ProgressLine line(options.quiet, scene.search.metric == design::Metric::rmse ? "W/m^2" : "");
  const design::RunControl control{&stop_on_signal(), [&](const design::Progress& p) { line.show(p); }};
  const design::DesignResult result = design::run_design(scene, control);
  line.show({"write", 1.0, std::numeric_limits<double>::quiet_NaN(), 0});
  const auto files = report::write_design(scene, result, out);
  line.finish();
  if (!options.quiet) {
    fmt::print("{}\n{}", result.search.sentence, report::text_table(report::summary_table(scene, result)));
    print_accuracy(result.best.judgement);
    fmt::print("{} evaluations in {:.3g} s, {} photons, {:.3g} s in all\n", result.search.evaluations,
               result.search_seconds, result.photons, result.seconds);
    for (const std::string& note : files.notes) fmt::print("note: {}\n", note);
    fmt::print("written to {}: {}\n", out.string(), fmt::join(files.names, ", "));
  }
  return with_accuracy(exit_code(result.search.ending), result.best.judgement);
}

ExitCode simulate_command(const CommonOptions& options) {
  const design::Scene scene = design::read_scene(options.input, options.overrides());
  const std::filesystem::path out = options.out_folder();
  prepare_output_folder(out);
  const design::ThreadLimit limit(scene.threads);
  ProgressLine line(options.quiet, "");
  const design::RunControl control{&stop_on_signal(), [&](const design::Progress& p) { line.show(p); }};
  const design::SimulationResult result = design::run_simulation(scene, control);
  const auto files = report::write_simulation(scene, result, out);
  line.finish();
  if (!options.quiet) {
    fmt::print("{}", report::text_table(report::simulation_table(scene, result)));
    print_accuracy(result.mirror.judgement);
    fmt::print("{} photons, {:.3g} s\n", result.photons, result.seconds);
    for (const std::string& note : files.notes) fmt::print("note: {}\n", note);
    fmt::print("written to {}: {}\n", out.string(), fmt::join(files.names, ", "));
  }
  return with_accuracy(ExitCode::done, result.mirror.judgement);
}

}  // namespace catoptric::cli
