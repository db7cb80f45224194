#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "design/scene.h"
#include "optim/search_tape.h"

namespace catoptric::report {

/// A search on disk: `checkpoint.json` in the run's folder, from which `design --resume` goes on to the same
/// bits. It holds the version, the scene and all answers; keys that only say how long to search (budgets) or
/// how to show it may differ when the search is resumed.
class Checkpoint {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param now   tells the time; a test has its own
  Checkpoint(const design::Scene& scene, const std::filesystem::path& folder,
             std::function<Clock::time_point()> now = Clock::now);

  bool exists() const;

  /// The answers of the search that was broken off.
  /// @fails InputError when the file cannot be read, is damaged, or is of another scene or version
  std::vector<optim::Answer> read() const;

  /// To be called after every answer. Writes the file unless that would take more than a twentieth of the
  /// time spent since it was last written. A killed run so loses the evaluation in flight, or, where
  /// evaluations are quick, 20 times what writing takes (here 0.1 s).
  /// @out   whether it was written
  /// @fails IoError
  bool keep(const optim::SearchTape& tape);

  /// Writes the file whole: temporary file, fsync, rename.
  /// @fails IoError
  void write(const optim::SearchTape& tape);

  /// Takes the file away, of a search that needs no more.
  void remove() const;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::function<Clock::time_point()> now_;
  std::filesystem::path path_;
  std::string scene_;
  Clock::time_point written_{};
  Clock::duration cost_{};
};

}  // namespace catoptric::report
