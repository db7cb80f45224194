#include <fmt/format.h>

#include <chrono>
#include <future>

#include "base/atomic_file.h"
#include "cli/commands.h"
#include "cli/json_lines.h"
#include "cli/scene_run.h"
#include "cli/stop_signal.h"
#include "design/memory_need.h"
#include "design/metrics.h"
#include "report/result_json.h"

namespace catoptric::cli {
namespace {

/// What one run came to. A run that fails is a row of the table, not the end of the study.
report::StudyRow run_one(const design::Study& study, const design::StudyRun& run, design::Scene scene,
                         const std::filesystem::path& folder, const design::RunControl& control) {
  report::StudyRow row{run, std::move(scene), {}, {}, ""};
  const design::ThreadLimit limit(row.scene->threads);
  try {
    prepare_output_folder(folder, report::room_for(*row.scene));
    if (study.designs)
      row.designed = design::run_design(*row.scene, control);
    else
      row.simulated = design::run_simulation(*row.scene, control);
  } catch (const IoError&) {
    throw;
  } catch (const Error& error) {
    row.error = error.what();
  }
  return row;
}

/// A run's files; what could not be exchanged becomes the row's error.
/// @fails IoError
void write_files(report::StudyRow& row, const std::filesystem::path& folder) {
  try {
    if (row.designed) report::write_design(*row.scene, *row.designed, folder);
    if (row.simulated) report::write_simulation(*row.scene, *row.simulated, folder);
  } catch (const IoError&) {
    throw;
  } catch (const Error& error) {
    row.error = error.what();
  }
}

bool accuracy_missed(const report::StudyRow& row) {
  if (!row.designed && !row.simulated) return false;
  const auto& accuracy = (row.designed ? row.designed->best : row.simulated->mirror).judgement.accuracy;
  return accuracy && !accuracy->proven;
}

bool ended_well(optim::Ending ending) {
  return ending == optim::Ending::converged || ending == optim::Ending::target_reached;
}

ExitCode exit_code(const std::vector<report::StudyRow>& rows, bool interrupted) {
  if (interrupted) return ExitCode::interrupted;
  ExitCode code = ExitCode::done;
  for (const report::StudyRow& row : rows) {
    if (!row.error.empty()) return ExitCode::geometry_or_exchange;
    if (row.designed &&
        (!ended_well(row.designed->search.ending) || report::outcome_word(*row.designed) == "unsatisfied"))
      code = ExitCode::unconverged;
    if (accuracy_missed(row)) code = ExitCode::unconverged;
  }
  return code;
}

}  // namespace

ExitCode study_command(const CommonOptions& options) {
  const design::Study list = design::read_study(options.input);
  std::vector<design::Scene> scenes;  // all are checked before the first one runs
  for (const design::StudyRun& run : list.runs) {
    scenes.push_back(design::study_scene(run, options.overrides()));
    design::require_memory(scenes.back());
  }
  const std::filesystem::path out = options.out_folder();
  std::uint64_t room = 0;
  for (const design::Scene& scene : scenes) room += report::room_for(scene);
  prepare_output_folder(out, room);

  if (options.json) json_begin(list.title, out);
  const auto begin = std::chrono::steady_clock::now();
  ProgressLine line(watcher(options), design::objective_unit(scenes.front()));
  const design::RunControl control{&stop_on_signal(), [&](const design::Progress& p) { line.show(p); }};
  std::vector<report::StudyRow> rows;
  rows.reserve(list.runs.size());  // a row stays where it is while its files are written
  std::future<void> writing;       // of the run before: plots and exchange need no light
  for (std::size_t i = 0; i < list.runs.size() && !control.stopped(); ++i) {
    line.set_prefix(fmt::format("run {} ({} of {})", list.runs[i].name, i + 1, list.runs.size()));
    const std::filesystem::path folder = out / list.runs[i].name;
    rows.push_back(run_one(list, list.runs[i], std::move(scenes[i]), folder, control));
    if (writing.valid()) writing.get();
    writing = std::async(std::launch::async, [&row = rows.back(), folder] { write_files(row, folder); });
  }
  if (writing.valid()) writing.get();
  line.finish();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto files = report::write_study(list, rows, seconds, out);
  if (options.tells_people()) {
    fmt::print("{}\n{}{:.1f} s in all\n", list.title, report::text_table(report::study_table(rows)), seconds);
  }
  tell_files(options, files, out, " and a folder per run");
  return exit_code(rows, control.stopped());
}

}  // namespace catoptric::cli
