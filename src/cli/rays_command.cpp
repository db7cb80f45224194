#include <fmt/format.h>

#include "base/atomic_file.h"
#include "cli/scene_run.h"
#include "report/ray_report.h"

namespace catoptric::cli {

ExitCode rays_command(const CommonOptions& options) {
  SceneRun run(options);
  prepare_output_folder(run.out, report::room_for_rays(run.scene));
  const auto [files, rays] = report::write_rays(run.scene, run.control, run.out);
  run.line.finish();
  if (options.tells_people()) {
    fmt::print("{}", report::text_table(report::ray_table(rays)));
    fmt::print("{}, read back and checked, {:.3g} s\n",
               run.scene.rays.of_luminaire ? "in the scene's frame, mm"
                                           : "in the source's own frame, mm (see source.toml)",
               rays.seconds);
  }
  run.tell_files(files);
  return ExitCode::done;
}

}  // namespace catoptric::cli
