#pragma once

#include <chrono>
#include <string>

#include "design/run.h"

namespace catoptric::cli {

/// Shows a run's progress on standard error: one bar that redraws itself on a terminal, a plain line now and
/// then elsewhere.
class ProgressLine {
 public:
  /// @in unit  what the best value is in
  ProgressLine(bool silent, std::string unit);
  ~ProgressLine();

  void show(const design::Progress& progress);
  /// Ends the bar, so that other text starts on a line of its own.
  void finish();
  /// Put before the phase, e.g. "run 3 of 8".
  void set_prefix(std::string prefix) { prefix_ = std::move(prefix); }

 private:
  std::string text(const design::Progress& progress) const;

  using Clock = std::chrono::steady_clock;
  bool silent_, terminal_;
  std::string unit_, prefix_;
  std::string phase_;
  Clock::time_point phase_begin_ = Clock::now(), last_shown_{};
  std::size_t drawn_width_ = 0;
};

}  // namespace catoptric::cli
