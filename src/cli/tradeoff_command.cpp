#include <fmt/format.h>

#include "cli/scene_run.h"
#include "report/trade_report.h"

namespace catoptric::cli {

ExitCode tradeoff_command(const CommonOptions& options) {
  SceneRun run(options);
  const design::Tradeoff trade = design::run_tradeoff(run.scene, run.control);
  if (!options.leads()) return ExitCode::done;
  const auto files = report::write_tradeoff(run.scene, trade, run.out);
  run.line.finish();
  if (options.tells_people()) {
    fmt::print("{}", report::text_table(report::front_table(run.scene, trade)));
    fmt::print("{}\n", trade.sentence);
    fmt::print("truth: {} (relative error {:.2g}); {} settings, {} left out, {:.1f} s, {}\n", trade.reference,
               trade.reference_error_rel, trade.rows.size(), trade.left_out.size(), trade.seconds,
               trade.machine);
  }
  run.tell_files(files);
  return run.control.stopped() ? ExitCode::interrupted : ExitCode::done;
}

}  // namespace catoptric::cli
