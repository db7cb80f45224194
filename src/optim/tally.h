#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "optim/problem.h"
#include "optim/search_limits.h"

namespace catoptric::optim {

/// Stands between a problem and a library's search: counts, keeps the best and the history, and ends the
/// search when its limits say so. The library sees only the variables that can move, each in its natural
/// unit: some libraries compare steps with absolute numbers, or add up what has different units.
class Tally {
 public:
  /// Thrown out of evaluate() to leave the library's loop.
  struct Over {};

  /// @in    problem and limits outlive this object
  /// @fails InputError as require_sound, or for a budget below 1
  Tally(const Problem& problem, const SearchLimits& limits, long evaluations_per_iteration);

  std::vector<double> start() const;
  std::vector<double> step() const;
  std::vector<double> lower() const;
  std::vector<double> upper() const;

  /// Evaluates the problem's start; false when that ended the search.
  bool begin();
  /// The start's value as evaluate() would give it.
  double start_value() const;

  /// The value at the free variables' values, clamped to the box. What cannot be built gets a finite value
  /// above all others, since the libraries' arithmetic needs numbers. The best point is not computed again.
  /// @fails Over, or whatever the objective throws
  double evaluate(std::span<const double> free_values);

  bool over() const { return ending_.has_value(); }
  bool found() const;  ///< whether any point had a value
  long evaluations() const { return outcome_.evaluations; }
  long evaluations_left() const { return limits_.most_evaluations - outcome_.evaluations; }

  /// The outcome; `by_itself` and `why` tell how the library ended if no limit did.
  Outcome finish(Ending by_itself, std::string why);

 private:
  double value_at(const std::vector<double>& x, const char* move);
  void take(const std::vector<double>& x, double value, const char* move);
  template <class Get>
  std::vector<double> of_free(Get get) const;  ///< in natural units
  std::string sentence(std::string why) const;

  const Problem& problem_;
  const SearchLimits& limits_;
  long per_iteration_;
  std::vector<std::size_t> free_;
  std::optional<Ending> ending_;
  Outcome outcome_{};
};

}  // namespace catoptric::optim
