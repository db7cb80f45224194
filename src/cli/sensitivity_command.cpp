#include <fmt/format.h>

#include "cli/scene_run.h"
#include "report/sensitivity_report.h"

namespace catoptric::cli {

ExitCode sensitivity_command(const CommonOptions& options) {
  SceneRun run(options);
  const design::Sensitivity sensitivity = design::run_sensitivity(run.scene, run.control);
  if (!options.leads()) return ExitCode::done;
  const auto files = report::write_sensitivity(run.scene, sensitivity, run.out);
  run.line.finish();
  if (options.tells_people()) {
    fmt::print("{}", report::text_table(report::tolerance_table(sensitivity)));
    fmt::print("{}\n", report::budget_sentence(sensitivity));
    fmt::print("{} photons, {:.3g} s\n", sensitivity.photons, sensitivity.seconds);
  }
  run.tell_files(files);
  return ExitCode::done;
}

}  // namespace catoptric::cli
