#pragma once

#include <filesystem>

#include "cli/commands.h"
#include "cli/progress_line.h"
#include "design/run.h"
#include "design/thread_limit.h"
#include "report/run_files.h"

namespace catoptric::cli {

/// What every command does that works on one scene and writes a folder: the scene is read and checked, the
/// folder made before anything is computed, threads limited, progress shown, and a signal listened to.
struct SceneRun {
  /// @fails InputError for a bad scene, IoError for a folder that cannot be written
  explicit SceneRun(const CommonOptions& options);
  SceneRun(const SceneRun&) = delete;
  SceneRun& operator=(const SceneRun&) = delete;

  /// Which files were written where, and what is to be noted; nothing with --quiet.
  void tell_files(report::WrittenFiles files) const;

 private:
  const CommonOptions options_;

 public:
  const design::Scene scene;
  const std::filesystem::path out;
  ProgressLine line;
  const design::RunControl control;

 private:
  design::ThreadLimit limit_;
};

/// Who is told of progress.
Watcher watcher(const CommonOptions& options);

/// Which files were written, for a command with several scenes.
void tell_files(const CommonOptions& options, const report::WrittenFiles& files,
                const std::filesystem::path& out, const char* more = "");

}  // namespace catoptric::cli
