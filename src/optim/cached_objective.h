#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "optim/problem.h"

namespace catoptric::optim {

/// A problem's objective that computes every point once and remembers it. Points are the same when all their
/// doubles compare equal (so 0 and -0 are one point). For one thread.
class CachedObjective {
 public:
  /// `problem` must outlive this object.
  explicit CachedObjective(const Problem& problem) : problem_(problem) {}

  /// The value of a point computed before; counts as a cache hit.
  std::optional<double> recall(std::span<const double> x);

  /// Computes a point that recall() did not know. NaN becomes infinity.
  /// @in    x within the box of the variables
  /// @fails whatever the objective throws; nothing is remembered then
  double compute(std::span<const double> x);

  long evaluations() const { return evaluations_; }
  long cache_hits() const { return cache_hits_; }

 private:
  const Problem& problem_;
  std::map<std::vector<double>, double> known_;
  long evaluations_ = 0;
  long cache_hits_ = 0;
};

}  // namespace catoptric::optim
