#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/atomic_file.h"
#include "cli/commands.h"
#include "cli/progress_line.h"
#include "cli/stop_signal.h"
#include "design/thread_limit.h"
#include "report/trade_report.h"

namespace catoptric::cli {

ExitCode tradeoff_command(const CommonOptions& options) {
  const design::Scene scene = design::read_scene(options.input, options.overrides());
  const std::filesystem::path out = options.out_folder();
  prepare_output_folder(out);
  const design::ThreadLimit limit(scene.threads);
  ProgressLine line(options.quiet, "");
  const design::RunControl control{&stop_on_signal(), [&](const design::Progress& p) { line.show(p); }};
  const design::Tradeoff trade = design::run_tradeoff(scene, control);
  const auto files = report::write_tradeoff(scene, trade, out);
  line.finish();
  if (!options.quiet) {
    fmt::print("{}", report::text_table(report::front_table(scene, trade)));
    fmt::print("{}\n", trade.sentence);
    fmt::print("truth: {} (relative error {:.2g}); {} settings, {} left out, {:.1f} s, {}\n", trade.reference,
               trade.reference_error_rel, trade.rows.size(), trade.left_out.size(), trade.seconds,
               trade.machine);
    for (const std::string& note : files.notes) fmt::print("note: {}\n", note);
    fmt::print("written to {}: {}\n", out.string(), fmt::join(files.names, ", "));
  }
  return control.stopped() ? ExitCode::interrupted : ExitCode::done;
}

}  // namespace catoptric::cli
