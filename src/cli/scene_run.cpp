#include "cli/scene_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/atomic_file.h"
#include "cli/json_lines.h"
#include "cli/stop_signal.h"
#include "cli/terminal.h"
#include "design/memory_need.h"
#include "design/metrics.h"

namespace catoptric::cli {
namespace {

std::filesystem::path prepared_folder(const CommonOptions& options, const design::Scene& scene) {
  design::require_memory(scene, options.ranks->size(), options.ranks->size_here());
  std::filesystem::path out = options.out_folder();
  if (options.leads()) prepare_output_folder(out, report::room_for(scene));
  return out;
}

/// A large need is said before it is felt.
void tell_memory(const design::Scene& scene, int ranks) {
  constexpr std::uint64_t worth_a_line = 1'000'000'000;
  const design::MemoryNeed need = design::memory_need(scene, ranks);
  if (need.bytes >= worth_a_line) fmt::print(stderr, "catoptric: memory: {}\n", need.sentence);
}

}  // namespace

SceneRun::SceneRun(const CommonOptions& options)
    : options_(options),
      scene(design::read_scene(options.input, options.overrides())),
      out(prepared_folder(options, scene)),
      line(watcher(options), design::objective_unit(scene)),
      control{.stop = &stop_on_signal(),
              .watch = [this](const design::Progress& progress) { line.show(progress); },
              .ranks = options.ranks},
      limit_(scene.threads) {
  if (options.tells_programs()) json_begin(scene.title, out);
  if (options.tells_people()) tell_memory(scene, options.ranks->size());
}

void SceneRun::tell_files(report::WrittenFiles files) const {
  for (const auto* more : {&scene.target.notes, &scene.profile_notes})
    files.notes.insert(files.notes.begin(), more->begin(), more->end());
  cli::tell_files(options_, files, out);
}

Watcher watcher(const CommonOptions& options) {
  if (!options.leads()) return Watcher::nobody;
  return options.json ? Watcher::program : options.quiet ? Watcher::nobody : Watcher::person;
}

void tell_files(const CommonOptions& options, const report::WrittenFiles& files,
                const std::filesystem::path& out, const char* more) {
  if (options.tells_programs()) json_written(files, out);
  if (!options.tells_people()) return;
  for (const std::string& note : files.notes)
    fmt::print("{} {}\n", inked("note:", Ink::warning, stdout), note);
  fmt::print("written to {}: {}{}\n", out.string(), fmt::join(files.names, ", "), more);
}

}  // namespace catoptric::cli
