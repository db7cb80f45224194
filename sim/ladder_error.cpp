#include "sim/ladder_error.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <optional>

#include "base/contract.h"
#include "base/ordered_sum.h"

namespace catoptric::sim {
namespace {

/// Mean square over the samples of a mean over sets, and of that mean's noise.
struct MeanSquare {
  double value = 0, variance = 0;
};

/// Of the difference between two readings of the same sets, or of one reading's noise (`other` null).
MeanSquare mean_square(const SetFields& sets, const SetFields* other) {
  const std::size_t count = sets.front().size();
  const double n = static_cast<double>(sets.size());
  std::vector<double> values(count), variances(count);
  for (std::size_t i = 0; i < count; ++i) {
    double mean = 0, square = 0;
    for (std::size_t set = 0; set < sets.size(); ++set)
      mean += (sets[set][i] - (other ? (*other)[set][i] : 0)) / n;
    for (std::size_t set = 0; set < sets.size(); ++set) {
      const double off = sets[set][i] - (other ? (*other)[set][i] : 0) - mean;
      square += off * off / (n * (n - 1));
    }
    values[i] = mean * mean;
    variances[i] = square;
  }
  return {ordered_sum(values) / static_cast<double>(count),
          ordered_sum(variances) / static_cast<double>(count)};
}

/// By how much a mean square with so many independent parts exceeds its expectation with a probability of
/// 5 %, when the expectation itself comes from the spread of so many sets.
double excess95(double independent, std::size_t sets) {
  const double spread_parts = independent * static_cast<double>(sets - 1);
  return boost::math::quantile(boost::math::fisher_f(independent, spread_parts), 0.95);
}

/// What narrowing by one level changes, root mean square.
struct Change {
  double seen = 0;    ///< its own noise taken off
  double hidden = 0;  ///< what noise could hide beside that
  bool stands_out = false;
};

Change change_between(const LadderLevel& wide, const LadderLevel& narrow, int order) {
  const SetFields &a = fields_of(wide, order), &b = fields_of(narrow, order);
  const MeanSquare difference = mean_square(a, &b);
  const double excess = excess95(narrow.independent, a.size()) - 1;
  Change change;
  change.stands_out = difference.value > difference.variance * (1 + excess);
  change.seen = std::sqrt(std::max(0.0, difference.value - difference.variance));
  change.hidden = std::sqrt(difference.variance * excess);
  return change;
}

/// Sum of this and all further changes.
double bias_bound(const std::vector<Change>& changes, std::size_t from, int order) {
  // Narrowing by the root of two leaves half of a bias of second order, a quarter of one of fourth; at a jump
  // 0.84 of it remains. A larger share would be no convergence.
  const double smooth = order == 2 ? 0.5 : 0.25;
  constexpr double slowest = 0.85;
  double sum = 0;
  std::optional<double> before;
  double share = smooth;
  for (std::size_t k = from; k < changes.size(); ++k) {
    const Change& change = changes[k];
    if (!change.stands_out) {
      if (!before) return std::hypot(change.seen, change.hidden) / (1 - smooth);
      break;
    }
    if (before) share = std::clamp(change.seen / *before, smooth, slowest);
    sum += change.seen;
    before = change.seen;
  }
  return sum + *before * share / (1 - share);
}

}  // namespace

std::vector<double> mean_of(const SetFields& sets) {
  std::vector<double> mean(sets.front().size(), 0.0);
  for (const auto& field : sets)
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += field[i] / static_cast<double>(sets.size());
  return mean;
}

std::vector<double> deviation_of_mean(const SetFields& sets) {
  const std::vector<double> mean = mean_of(sets);
  const double n = static_cast<double>(sets.size());
  std::vector<double> deviation(mean.size(), 0.0);
  for (const auto& field : sets)
    for (std::size_t i = 0; i < mean.size(); ++i)
      deviation[i] += (field[i] - mean[i]) * (field[i] - mean[i]) / (n * (n - 1));
  for (double& each : deviation) each = std::sqrt(each);
  return deviation;
}

const SetFields& fields_of(const LadderLevel& level, int order) {
  return order == 2 ? level.second : level.fourth;
}

LadderChoice best_choice(const BandwidthLadder& ladder) {
  CATOPTRIC_EXPECTS(ladder.levels.size() >= 2 && ladder.levels.front().second.size() >= 2);
  LadderChoice best;
  best.error95 = HUGE_VAL;
  for (const int order : {2, 4}) {
    std::vector<Change> changes;
    for (std::size_t level = 0; level + 1 < ladder.levels.size(); ++level)
      changes.push_back(change_between(ladder.levels[level], ladder.levels[level + 1], order));
    for (std::size_t level = 0; level < changes.size(); ++level) {
      const LadderLevel& at = ladder.levels[level];
      const SetFields& sets = fields_of(at, order);
      const double variance = mean_square(sets, nullptr).variance;
      LadderChoice choice{level, order, std::sqrt(variance), bias_bound(changes, level, order), 0};
      choice.error95 =
          std::sqrt(variance * excess95(at.independent, sets.size()) + choice.bias * choice.bias);
      if (choice.error95 < best.error95) best = choice;
    }
  }
  return best;
}

}  // namespace catoptric::sim
