#pragma once

#include <filesystem>
#include <string>

#include "base/errors.h"
#include "design/run.h"
#include "report/run_files.h"
#include "sim/planner.h"

namespace catoptric::cli {

/// What a run tells a program (--json): one JSON object a line on standard output, each with an `event`.

/// {"event": "begin", "title", "folder"}
void json_begin(const std::string& title, const std::filesystem::path& folder);

/// How fast a run goes, beside what it says of itself.
struct Pace {
  double evaluations_per_s = 0;  ///< 0: nothing is evaluated
  double seconds_left = -1;      ///< negative: not known yet
};

/// {"event": "progress", "phase", "share", "best", "unit", "iterations", "evaluations",
/// "evaluations_per_second", "seconds_left", "note"}; what is not known is null.
void json_progress(const std::string& phase, const design::Progress& progress, const Pace& pace,
                   const std::string& unit);

/// {"event": "written", "folder", "files", "notes", "result"}; `result` is what the first of the files holds
/// that is JSON.
void json_written(const report::WrittenFiles& files, const std::filesystem::path& folder);

/// {"event": "plan", "purpose", "rung", "findings"}: each finding has a feature, what was found, its
/// consequence.
void json_plan(const std::string& purpose, const sim::Plan& plan);

/// {"event": "error", "what", "where", "why", "hint", "exit_code"}
void json_error(const ErrorParts& parts, ExitCode code);

/// {"event": "end", "exit_code"}: the last line, whatever happened.
void json_end(ExitCode code);

}  // namespace catoptric::cli
