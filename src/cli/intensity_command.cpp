#include <fmt/format.h>

#include "cli/scene_run.h"
#include "report/intensity_report.h"

namespace catoptric::cli {

ExitCode intensity_command(const CommonOptions& options) {
  SceneRun run(options);
  const design::LuminaireIntensity luminaire = design::run_intensity(run.scene, run.control);
  const auto files = report::write_intensity(run.scene, luminaire, run.out);
  run.line.finish();
  if (options.tells_people()) {
    fmt::print("{}", report::text_table(report::luminaire_table(luminaire)));
    if (!luminaire.remark.empty()) fmt::print("{}\n", luminaire.remark);
    fmt::print("{} photons, {:.3g} s\n", luminaire.photons, luminaire.seconds);
  }
  run.tell_files(files);
  return ExitCode::done;
}

}  // namespace catoptric::cli
