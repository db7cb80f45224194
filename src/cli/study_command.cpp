#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <future>

#include "base/atomic_file.h"
#include "base/byte_record.h"
#include "base/recorded_ranks.h"
#include "base/sent_folder.h"
#include "cli/commands.h"
#include "cli/json_lines.h"
#include "cli/scene_run.h"
#include "cli/stop_signal.h"
#include "design/memory_need.h"
#include "design/metrics.h"
#include "design/shared_work.h"
#include "report/result_json.h"

namespace catoptric::cli {
namespace {

/// What one run came to. A run that fails is a row of the table, not the end of the study.
report::StudyRow run_one(const design::Study& study, const design::StudyRun& run, const design::Scene& scene,
                         const design::RunControl& control) {
  report::StudyRow row{run, scene, {}, {}, ""};
  const design::ThreadLimit limit(row.scene->threads);
  try {
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

/// The runs of a study one after the other, their rows kept and their files written by rank 0.
class StudyRunner {
 public:
  StudyRunner(const CommonOptions& options, const design::Study& list,
              const std::vector<design::Scene>& scenes)
      : options_(options),
        list_(list),
        scenes_(scenes),
        line_(watcher(options), design::objective_unit(scenes.front())),
        control_{.stop = &stop_on_signal(),
                 .watch = [this](const design::Progress& p) { line_.show(p); },
                 .ranks = options.ranks} {
    rows_.reserve(list.runs.size());  // a row stays where it is while its files are written
  }

  /// Each run by one rank where there are as many runs as ranks, else each by all ranks.
  std::vector<report::StudyRow> run() {
    if (options_.ranks->size() > 1 && list_.runs.size() >= static_cast<std::size_t>(options_.ranks->size()))
      run_side_by_side();
    else
      run_together();
    if (writing_.valid()) writing_.get();
    line_.finish();
    return std::move(rows_);
  }

  bool stopped() const { return control_.stopped(); }

 private:
  std::filesystem::path folder(std::size_t i) const { return options_.out_folder() / list_.runs[i].name; }

  void announce(std::size_t i) {
    line_.set_prefix(fmt::format("run {} ({} of {})", list_.runs[i].name, i + 1, list_.runs.size()));
  }

  void run_together() {
    for (std::size_t i = 0; i < list_.runs.size() && !design::stopped_for_all(control_); ++i) {
      announce(i);
      if (options_.leads()) prepare_output_folder(folder(i), report::room_for(scenes_[i]));
      keep(i, run_one(list_, list_.runs[i], scenes_[i], control_));
    }
  }

  /// Ranks send what their run's tasks gave, from which rank 0 repeats the run in no time for its row, and
  /// the run's files, whose plots take longer than many a run.
  void run_side_by_side() {
    const auto recorded = [&](std::size_t i) {
      if (control_.stopped()) return Bytes();
      announce(i);
      RecordingRanks recorder;
      design::RunControl alone = control_;
      alone.ranks = &recorder;
      report::StudyRow row = run_one(list_, list_.runs[i], scenes_[i], alone);
      const ScratchFolder made;
      write_files(row, made.path());
      return ByteWriter()
          .put(row.designed || row.simulated)
          .put(row.error)
          .put(recorder.log())
          .put(folder_bytes(made.path()))
          .take();
    };
    const auto repeated = [&](std::size_t i, const Bytes& sent) {
      if (sent.empty()) return;
      prepare_output_folder(folder(i), report::room_for(scenes_[i]));
      ByteReader reader(sent);
      const bool has_result = reader.get<bool>();
      report::StudyRow row{list_.runs[i], scenes_[i], {}, {}, reader.get<std::string>()};
      RepeatingRanks repeating(reader.get<JoinLog>());
      if (has_result) {
        report::StudyRow again = run_one(list_, list_.runs[i], scenes_[i], {.ranks = &repeating});
        if (again.error.empty()) again.error = std::move(row.error);
        row = std::move(again);
      }
      rows_.push_back(std::move(row));
      write_beside([files = reader.get<std::string>(), to = folder(i)] { write_folder(files, to); });
    };
    options_.ranks->join(list_.runs.size(), recorded, repeated, [] { return Bytes(); });
  }

  void keep(std::size_t i, report::StudyRow row) {
    if (!options_.leads()) return;
    rows_.push_back(std::move(row));
    write_beside([&row = rows_.back(), to = folder(i)] { write_files(row, to); });
  }

  /// Files of the run before are written while the next is at work: plots and exchange need no light.
  void write_beside(std::function<void()> write) {
    if (writing_.valid()) writing_.get();
    writing_ = std::async(std::launch::async, std::move(write));
  }

  const CommonOptions& options_;
  const design::Study& list_;
  const std::vector<design::Scene>& scenes_;
  ProgressLine line_;
  const design::RunControl control_;
  std::vector<report::StudyRow> rows_;
  std::future<void> writing_;
};

}  // namespace

ExitCode study_command(const CommonOptions& options) {
  const design::Study list = design::read_study(options.input);
  std::vector<design::Scene> scenes;  // all are checked before the first one runs
  for (const design::StudyRun& run : list.runs) {
    scenes.push_back(design::study_scene(run, options.overrides()));
  }
  // Runs that are fewer than the ranks are shared by all of them.
  const bool one_rank_each = list.runs.size() >= static_cast<std::size_t>(options.ranks->size());
  for (const design::Scene& scene : scenes)
    design::require_memory(scene, one_rank_each ? 1 : options.ranks->size(), options.ranks->size_here());
  const std::filesystem::path out = options.out_folder();
  std::uint64_t room = 0;
  for (const design::Scene& scene : scenes) room += report::room_for(scene);
  if (options.leads()) prepare_output_folder(out, room);

  if (options.tells_programs()) json_begin(list.title, out);
  const auto begin = std::chrono::steady_clock::now();
  StudyRunner runner(options, list, scenes);
  const std::vector<report::StudyRow> rows = runner.run();
  if (!options.leads()) return ExitCode::done;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto files = report::write_study(list, rows, seconds, out);
  if (options.tells_people()) {
    fmt::print("{}\n{}{:.1f} s in all\n", list.title, report::text_table(report::study_table(rows)), seconds);
  }
  tell_files(options, files, out, " and a folder per run");
  return exit_code(rows, runner.stopped());
}

}  // namespace catoptric::cli
