#include "cli/progress_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/terminal.h"

namespace catoptric::cli {

ProgressLine::ProgressLine(Watcher watcher, std::string unit)
    : watcher_(watcher), terminal_(is_terminal(stderr)), unit_(std::move(unit)) {}

ProgressLine::~ProgressLine() { finish(); }

void ProgressLine::finish() {
  if (drawn_width_ == 0) return;
  fmt::print(stderr, "\r{}\r", std::string(drawn_width_, ' '));
  std::fflush(stderr);
  drawn_width_ = 0;
}

bool ProgressLine::is_due(const std::string& phase) {
  using namespace std::chrono_literals;
  const auto now = Clock::now();
  if (phase != phase_) {
    phase_ = phase;
    phase_begin_ = now;
  } else if (now - last_shown_ < (watcher_ == Watcher::program ? 500ms : terminal_ ? 100ms : 10s)) {
    return false;
  }
  last_shown_ = now;
  return true;
}

Pace ProgressLine::pace(const design::Progress& progress) const {
  const double passed_s = std::chrono::duration<double>(Clock::now() - phase_begin_).count();
  Pace pace;
  constexpr double least_s = 0.05;  // before that a rate means nothing
  if (progress.evaluations > 0 && passed_s > least_s)
    pace.evaluations_per_s = static_cast<double>(progress.evaluations) / passed_s;
  constexpr double least_share = 0.02;  // nor does a guess of the end
  if (progress.share > least_share && progress.share < 1)
    pace.seconds_left = passed_s * (1 - progress.share) / progress.share;
  return pace;
}

std::string ProgressLine::phase_text(const design::Progress& progress) const {
  return prefix_.empty() ? progress.phase : prefix_ + ", " + progress.phase;
}

std::string ProgressLine::text(const design::Progress& progress) const {
  const Pace pace = this->pace(progress);
  std::string line = phase_text(progress);
  if (progress.iterations > 0) line += fmt::format(", iteration {}", progress.iterations);
  if (!std::isnan(progress.best)) line += fmt::format("  best {:.4g} {}", progress.best, unit_);
  if (progress.evaluations > 0) line += fmt::format("  {} evals", progress.evaluations);
  if (pace.evaluations_per_s > 0) line += fmt::format("  {:.3g}/s", pace.evaluations_per_s);
  if (!progress.note.empty()) line += "  " + progress.note;
  if (pace.seconds_left >= 0) line += fmt::format("  {:.0f} s left", pace.seconds_left);
  return line;
}

void ProgressLine::show(const design::Progress& progress) {
  if (watcher_ == Watcher::nobody || !is_due(progress.phase)) return;
  if (watcher_ == Watcher::program)
    json_progress(phase_text(progress), progress, pace(progress), unit_);
  else if (terminal_)
    draw_bar(progress);
  else
    fmt::print(stderr, "{:3.0f} %  {}\n", 100 * progress.share, text(progress));
}

void ProgressLine::draw_bar(const design::Progress& progress) {
  const std::size_t columns = terminal_columns();
  const auto width = std::clamp<std::size_t>(columns / 12, 6, 24);
  const auto full = static_cast<std::size_t>(
      std::lround(std::clamp(progress.share, 0.0, 1.0) * static_cast<double>(width)));
  const std::string bar(full, '#'), rest(width - full, '.');
  std::string words = fmt::format(" {:3.0f} %  {}", 100 * progress.share, text(progress));
  // A line that wraps cannot be drawn over.
  constexpr std::size_t brackets = 2;
  const std::size_t room = columns - std::min(columns, width + brackets + 1);
  if (words.size() > room) {
    words.resize(room);
    while (!words.empty() && (words.back() & 0x80) != 0) words.pop_back();  // half of a letter
  }
  const std::size_t drawn = width + brackets + words.size();
  const std::size_t blank = drawn_width_ > drawn ? drawn_width_ - drawn : 0;
  fmt::print(stderr, "\r[{}{}]{}{}", inked(bar, Ink::good, stderr), rest, words, std::string(blank, ' '));
  std::fflush(stderr);
  drawn_width_ = drawn;
}

}  // namespace catoptric::cli
