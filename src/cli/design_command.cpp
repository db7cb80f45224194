#include <fmt/format.h>

#include <limits>

#include "cli/scene_run.h"
#include "cli/stop_signal.h"
#include "report/run_tables.h"

namespace catoptric::cli {
namespace {

/// A result that breaks constraints is no design, however well the search converged.
ExitCode exit_code(const design::DesignResult& result) {
  switch (result.search.ending) {
    case optim::Ending::converged:
    case optim::Ending::target_reached:
      return design::violation(result.best.constraints) > 0 ? ExitCode::unconverged : ExitCode::done;
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

void print_constraints(const design::Scene& scene, const design::Judged& judged) {
  if (judged.constraints.empty()) return;
  fmt::print("{}{}\n", report::text_table(report::constraint_table(scene, judged.constraints)),
             design::sentence(judged.constraints, scene.unit));
}

}  // namespace

ExitCode design_command(const CommonOptions& options) {
  SceneRun run(options);
  const design::DesignResult result = design::run_design(run.scene, run.control);
  run.line.show({"write", 1.0, std::numeric_limits<double>::quiet_NaN(), 0});
  const auto files = report::write_design(run.scene, result, run.out);
  run.line.finish();
  if (!options.quiet) {
    fmt::print("{}\n{}", result.search.sentence,
               report::text_table(report::summary_table(run.scene, result)));
    print_constraints(run.scene, result.best);
    print_accuracy(result.best.judgement);
    fmt::print("{} evaluations in {:.3g} s, {} photons, {:.3g} s in all\n", result.search.evaluations,
               result.search_seconds, result.photons, result.seconds);
    run.print_files(files);
  }
  return with_accuracy(exit_code(result), result.best.judgement);
}

ExitCode simulate_command(const CommonOptions& options) {
  SceneRun run(options);
  const design::SimulationResult result = design::run_simulation(run.scene, run.control);
  const auto files = report::write_simulation(run.scene, result, run.out);
  run.line.finish();
  if (!options.quiet) {
    fmt::print("{}", report::text_table(report::simulation_table(run.scene, result)));
    print_constraints(run.scene, result.mirror);
    print_accuracy(result.mirror.judgement);
    fmt::print("{} photons, {:.3g} s\n", result.photons, result.seconds);
    run.print_files(files);
  }
  return with_accuracy(ExitCode::done, result.mirror.judgement);
}

}  // namespace catoptric::cli
