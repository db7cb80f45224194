#include "cli/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace catoptric::cli {

ProgressLine::ProgressLine(bool silent, std::string unit)
    : silent_(silent), terminal_(::isatty(STDERR_FILENO) == 1), unit_(std::move(unit)) {}

ProgressLine::~ProgressLine() { finish(); }

void ProgressLine::finish() {
  if (drawn_width_ == 0) return;
  fmt::print(stderr, "\r{}\r", std::string(drawn_width_, ' '));
  std::fflush(stderr);
  drawn_width_ = 0;
}

std::string ProgressLine::text(const design::Progress& progress) const {
  std::string line = prefix_.empty() ? progress.phase : prefix_ + ", " + progress.phase;
  if (!std::isnan(progress.best)) line += fmt::format("  best {:.4g} {}", progress.best, unit_);
  if (progress.evaluations > 0) line += fmt::format("  {} evaluations", progress.evaluations);
  if (!progress.note.empty()) line += "  " + progress.note;
  const double passed = std::chrono::duration<double>(Clock::now() - phase_begin_).count();
  if (progress.share > 0.02 && progress.share < 1)  // before that a guess of the end means nothing
    line += fmt::format("  about {:.0f} s left", passed * (1 - progress.share) / progress.share);
  return line;
}

void ProgressLine::show(const design::Progress& progress) {
  if (silent_) return;
  using namespace std::chrono_literals;
  const bool new_phase = progress.phase != phase_;
  if (new_phase) {
    phase_ = progress.phase;
    phase_begin_ = Clock::now();
  }
  if (!new_phase && Clock::now() - last_shown_ < (terminal_ ? 100ms : 10s)) return;
  last_shown_ = Clock::now();
  if (!terminal_) {
    fmt::print(stderr, "{:3.0f} %  {}\n", 100 * progress.share, text(progress));
    return;
  }
  constexpr int width = 24;
  const int full = static_cast<int>(std::lround(progress.share * width));
  const std::string line = fmt::format(
      "[{}{}] {:3.0f} %  {}", std::string(static_cast<std::size_t>(full), '#'),
      std::string(static_cast<std::size_t>(width - full), '.'), 100 * progress.share, text(progress));
  const std::size_t blank = drawn_width_ > line.size() ? drawn_width_ - line.size() : 0;
  fmt::print(stderr, "\r{}{}", line, std::string(blank, ' '));
  std::fflush(stderr);
  drawn_width_ = line.size();
}

}  // namespace catoptric::cli
