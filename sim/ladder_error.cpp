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

/// By how much a mean square with so many independent parts may exceed its expectation, when the expectation
/// itself comes from the spread of so many sets. The level of 99 % leaves room for choosing the least of some
/// dozen bounds, so that the chosen one holds in 95 %.
double excess(double independent, std::size_t sets) {
  const double spread_parts = independent * static_cast<double>(sets - 1);
  return boost::math::quantile(boost::math::fisher_f(independent, spread_parts), 0.99);
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
  const double over = excess(narrow.independent, a.size()) - 1;
  Change change;
  change.stands_out = difference.value > difference.variance * (1 + over);
  change.seen = std::sqrt(std::max(0.0, difference.value - difference.variance));
  change.hidden = std::sqrt(difference.variance * over);
  return change;
}

/// By which share a change follows the one before, from the last two that stand out up to level `last`;
/// nothing where none stands out.
struct Decay {
  std::size_t level;  ///< of the last change that stands out
  double share;
};

/// Narrowing by the root of two leaves half of a bias of second order, a quarter of one of fourth.
double smooth_share(int order) { return order == 2 ? 0.5 : 0.25; }

/// The least of many bounds is the one that noise made small: by some 3 % where the bounds are sharpest (the
/// unit test with 400 independent kernels), the share of a bias still to come by as much.
constexpr double choosers_margin = 1.1;

/// At a jump 2^(-1/4) = 0.84 of the bias remains; more would be no convergence. Noise gets some room.
constexpr double jump_share = 0.87;

/// Changes are looked at from the widest kernel on, where noise hides least. The share is the last one seen,
/// or that over the last few steps where noise made the last one look better.
std::optional<Decay> decay_of(const std::vector<Change>& changes, int order) {
  constexpr std::size_t few = 3;
  std::optional<Decay> decay;
  for (std::size_t k = 0; k < changes.size() && changes[k].stands_out; ++k) {
    double share = k > 0 ? 0.0 : jump_share;
    for (std::size_t steps = 1; steps <= std::min(k, few); ++steps)
      share = std::max(share,
                       std::pow(changes[k].seen / changes[k - steps].seen, 1.0 / static_cast<double>(steps)));
    // Slower than any smooth field: a jump, whose share noise must not make smaller.
    constexpr double slowest_smooth = 0.6;
    decay = Decay{k, share > slowest_smooth ? jump_share : std::max(share, smooth_share(order))};
  }
  // The next change does not stand out; what it can be at most bounds the share too.
  if (decay && decay->level + 1 < changes.size()) {
    const Change& next = changes[decay->level + 1];
    const double most = std::hypot(next.seen, next.hidden) / changes[decay->level].seen;
    decay->share = std::max(smooth_share(order), std::min(decay->share, most));
  }
  return decay;
}

/// Sum of the change at a level and of all further ones.
/// @in    least_share: how slowly bias is known to fall at least
double bias_bound(const std::vector<Change>& changes, std::size_t from, const std::optional<Decay>& decay,
                  double least_share) {
  const double share = std::max(least_share, decay ? decay->share : 0.0);
  const double hidden = std::hypot(changes[from].seen, changes[from].hidden) / (1 - share);
  if (!decay) return hidden;
  if (decay->level < from) {
    const double steps = static_cast<double>(from - decay->level);
    return std::min(hidden, changes[decay->level].seen * std::pow(share, steps) / (1 - share));
  }
  double sum = 0;
  for (std::size_t k = from; k <= decay->level; ++k) sum += changes[k].seen;
  return sum + changes[decay->level].seen * share / (1 - share);
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
  double least_share = smooth_share(2);
  for (const int order : {2, 4}) {
    std::vector<Change> changes;
    for (std::size_t level = 0; level + 1 < ladder.levels.size(); ++level)
      changes.push_back(change_between(ladder.levels[level], ladder.levels[level + 1], order));
    const auto decay = decay_of(changes, order);
    // What is a jump to a kernel of second order is one to a kernel of fourth.
    if (order == 4) least_share = least_share > 1.2 * smooth_share(2) ? least_share : smooth_share(4);
    for (std::size_t level = 0; level < changes.size(); ++level) {
      const LadderLevel& at = ladder.levels[level];
      const SetFields& sets = fields_of(at, order);
      const double variance = mean_square(sets, nullptr).variance;
      LadderChoice choice{level, order, std::sqrt(variance), bias_bound(changes, level, decay, least_share),
                          0};
      choice.error95 = choosers_margin *
                       std::sqrt(variance * excess(at.independent, sets.size()) + choice.bias * choice.bias);
      if (choice.error95 < best.error95) best = choice;
    }
    if (order == 2 && decay) least_share = std::max(least_share, decay->share);
  }
  return best;
}

}  // namespace catoptric::sim
