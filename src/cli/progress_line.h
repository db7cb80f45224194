#pragma once

#include <chrono>
#include <string>

#include "cli/json_lines.h"
#include "design/run.h"

namespace catoptric::cli {

/// Who is told of a run's progress: nobody, a person (one bar that redraws itself on a terminal, a plain line
/// now and then elsewhere; standard error), or a program (JSON lines; standard output).
enum class Watcher { nobody, person, program };

class ProgressLine {
 public:
  /// @in unit  what the best value is in
  ProgressLine(Watcher watcher, std::string unit);
  ~ProgressLine();

  void show(const design::Progress& progress);
  /// Ends the bar, so that other text starts on a line of its own.
  void finish();
  /// Put before the phase, e.g. "run 3 of 8".
  void set_prefix(std::string prefix) { prefix_ = std::move(prefix); }

 private:
  using Clock = std::chrono::steady_clock;

  bool is_due(const std::string& phase);
  Pace pace(const design::Progress& progress) const;
  std::string phase_text(const design::Progress& progress) const;
  std::string text(const design::Progress& progress) const;
  void draw_bar(const design::Progress& progress);

  Watcher watcher_;
  bool terminal_;
  std::string unit_, prefix_;
  std::string phase_;
  Clock::time_point phase_begin_ = Clock::now(), last_shown_{};
  std::size_t drawn_width_ = 0;
};

}  // namespace catoptric::cli
