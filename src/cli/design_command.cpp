#include <fmt/format.h>

#include <limits>

#include "base/byte_record.h"
#include "cli/scene_run.h"
#include "cli/stop_signal.h"
#include "report/field_report.h"
#include "report/run_checkpoint.h"
#include "report/run_tables.h"

namespace catoptric::cli {
namespace {

/// What a search with its checkpoint was told so far, and the file that follows it.
struct ResumableSearch {
  ResumableSearch(const SceneRun& run, bool resume, Ranks& ranks)
      : file(run.scene, run.out), tape(resume ? known(ranks) : std::vector<optim::Answer>{}) {
    if (!ranks.leads()) return;
    if (resume && !file.exists())
      fmt::print(stderr, "catoptric: no checkpoint in {}: the search begins anew\n", run.out.string());
    tape.grown = [this](const optim::SearchTape& grown) { file.keep(grown); };
  }

  /// Rank 0 reads, all are told: on other machines there may be no such file.
  std::vector<optim::Answer> known(Ranks& ranks) const {
    const Bytes bytes = ranks.from_first([&] {
      ByteWriter writer;
      for (const optim::Answer& each : file.exists() ? file.read() : std::vector<optim::Answer>{})
        writer.put(each.x).put(each.value);
      return writer.take();
    });
    std::vector<optim::Answer> answers;
    for (ByteReader reader(bytes); !reader.at_end();) {
      auto x = reader.get<std::vector<double>>();
      answers.push_back({std::move(x), reader.get<double>()});
    }
    return answers;
  }

  report::Checkpoint file;
  optim::SearchTape tape;
};

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

/// A budget that is spent is not found again by itself.
std::string how_to_go_on(const CommonOptions& options, ExitCode code) {
  return fmt::format("go on from here with: catoptric design {} --out {} --resume{}", options.input.string(),
                     options.out_folder().string(),
                     code == ExitCode::unconverged ? " and a larger search.most_evaluations" : "");
}

void print_accuracy(const design::Judgement& judgement) {
  if (judgement.accuracy) fmt::print("{}\n", judgement.accuracy->sentence);
}

void print_field(const design::Scene& scene, const design::Judgement& judgement) {
  fmt::print("{}", report::text_table(report::field_table(scene, judgement)));
}

void print_constraints(const design::Scene& scene, const design::Judged& judged) {
  if (judged.constraints.empty()) return;
  fmt::print("{}{}\n", report::text_table(report::constraint_table(scene, judged.constraints)),
             design::sentence(judged.constraints, scene.unit));
}

}  // namespace

ExitCode design_command(const CommonOptions& options, const DesignOptions& more) {
  SceneRun run(options);
  ResumableSearch search(run, more.resume, *options.ranks);
  design::RunControl control = run.control;
  control.tape = &search.tape;
  const design::DesignResult result = design::run_design(run.scene, control);
  if (!options.leads()) return ExitCode::done;
  run.line.show({"write", 1.0, std::numeric_limits<double>::quiet_NaN(), 0});
  const auto files = report::write_design(run.scene, result, run.out);
  run.line.finish();
  if (options.tells_people()) {
    fmt::print("{}\n{}", result.search.sentence,
               report::text_table(report::summary_table(run.scene, result)));
    print_field(run.scene, result.best.judgement);
    print_constraints(run.scene, result.best);
    print_accuracy(result.best.judgement);
    fmt::print("{} evaluations in {:.3g} s, {} photons, {:.3g} s in all\n", result.search.evaluations,
               result.search_seconds, result.photons, result.seconds);
  }
  run.tell_files(files);
  ExitCode code = with_accuracy(exit_code(result), result.best.judgement);
  if (code == ExitCode::done && control.stopped()) code = ExitCode::interrupted;  // in the verdict
  if (code == ExitCode::done) {
    search.file.remove();
  } else {
    search.file.write(search.tape);
    if (options.tells_people()) fmt::print("{}\n", how_to_go_on(options, code));
  }
  return code;
}

ExitCode simulate_command(const CommonOptions& options) {
  SceneRun run(options);
  const design::SimulationResult result = design::run_simulation(run.scene, run.control);
  if (!options.leads()) return ExitCode::done;
  const auto files = report::write_simulation(run.scene, result, run.out);
  run.line.finish();
  if (options.tells_people()) {
    fmt::print("{}", report::text_table(report::simulation_table(run.scene, result)));
    print_field(run.scene, result.mirror.judgement);
    print_constraints(run.scene, result.mirror);
    print_accuracy(result.mirror.judgement);
    fmt::print("{} photons, {:.3g} s\n", result.photons, result.seconds);
  }
  run.tell_files(files);
  return with_accuracy(ExitCode::done, result.mirror.judgement);
}

}  // namespace catoptric::cli
