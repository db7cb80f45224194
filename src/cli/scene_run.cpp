#include "cli/scene_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/atomic_file.h"
#include "cli/stop_signal.h"
#include "design/metrics.h"

namespace catoptric::cli {
namespace {

std::filesystem::path prepared_folder(const CommonOptions& options) {
  std::filesystem::path out = options.out_folder();
  prepare_output_folder(out);
  return out;
}

}  // namespace

SceneRun::SceneRun(const CommonOptions& options)
    : scene(design::read_scene(options.input, options.overrides())),
      out(prepared_folder(options)),
      line(options.quiet, design::unit(scene.search.metric)),
      control{&stop_on_signal(), [this](const design::Progress& progress) { line.show(progress); }},
      limit_(scene.threads) {}

void SceneRun::print_files(const report::WrittenFiles& files) const {
  for (const std::string& note : scene.profile_notes) fmt::print("note: {}\n", note);
  cli::print_files(files, out);
}

void print_files(const report::WrittenFiles& files, const std::filesystem::path& out, const char* more) {
  for (const std::string& note : files.notes) fmt::print("note: {}\n", note);
  fmt::print("written to {}: {}{}\n", out.string(), fmt::join(files.names, ", "), more);
}

}  // namespace catoptric::cli
