#include "sim/ladder_error.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <optional>

#include "base/contract.h"
#include "base/ordered_sum.h"
#include "base/units.h"

namespace catoptric::sim {
namespace {

/// Mean square over the samples of a mean over sets, and of that mean's noise.
struct MeanSquare {
  double value = 0, variance = 0;
};

/// Of the difference between two readings of the same sets, or of one reading's noise (`other` null).
MeanSquare mean_square(const SetFields& sets, const SetFields* other, std::span<const double> shares) {
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
    values[i] = shares[i] * mean * mean;
    variances[i] = shares[i] * square;
  }
  return {ordered_sum(values), ordered_sum(variances)};
}

/// Mean square of the light that may fall where no set shows any.
double unseen_square(const LadderLevel& level, std::span<const double> shares, const LadderPhotons& photons) {
  double dark_share = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto is_dark = [i](const std::vector<double>& field) { return field[i] == 0; };
    if (std::ranges::all_of(level.second, is_dark) && std::ranges::all_of(level.fourth, is_dark))
      dark_share += shares[i];
  }
  constexpr double most_photons_unseen = 3;  // whose mean shows none in 5 % of all cases
  const double kernel_mm2 = pi * level.kernel_radius_mm * level.kernel_radius_mm;
  const double brightest = most_photons_unseen * photons.power_w / kernel_mm2;
  return std::min(dark_share, kernel_mm2 / photons.area_mm2) * brightest * brightest;
}

/// By how much a mean square with so many independent parts may exceed its expectation, when the expectation
/// itself comes from the spread of so many sets. The level of 99 % leaves room for choosing the least of some
/// dozen bounds, so that the chosen one holds in 95 %.
double excess(double independent, std::size_t sets) {
  const double spread_parts = independent * static_cast<double>(sets - 1);
  using Plain =
      boost::math::policies::policy<boost::math::policies::promote_double<false>>;  // thrice as fast
  return boost::math::quantile(boost::math::fisher_f_distribution<double, Plain>(independent, spread_parts),
                               0.99);
}

/// Of the bias, by the index that readings have.
constexpr std::array<int, 2> orders{2, 4};

/// What narrowing by one level changes, root mean square.
struct Change {
  double seen = 0;    ///< its own noise taken off
  double hidden = 0;  ///< what noise could hide beside that
  bool stands_out = false;
};

Change change_of(const LadderReading& reading, double excess_of_narrow) {
  const double over = excess_of_narrow - 1;
  Change change;
  change.stands_out = reading.change > reading.change_variance * (1 + over);
  change.seen = std::sqrt(std::max(0.0, reading.change - reading.change_variance));
  change.hidden = std::sqrt(reading.change_variance * over);
  return change;
}

/// Of all levels but the last.
std::vector<Change> changes_of(const LadderSummary& ladder, std::size_t order) {
  std::vector<Change> changes;
  for (std::size_t level = 0; level + 1 < ladder.levels.size(); ++level)
    changes.push_back(change_of(ladder.levels[level].orders[order], ladder.levels[level + 1].excess));
  return changes;
}

/// By which share a change follows the one before, from the last two that stand out up to level `last`;
/// nothing where none stands out.
struct Decay {
  std::size_t level;    ///< of the last change that stands out
  double share;         ///< no less than this is certain
  double likely_share;  ///< to be expected
};

/// Narrowing by the root of two leaves half of a bias of second order, a quarter of one of fourth.
double smooth_share(int order) { return order == 2 ? 0.5 : 0.25; }

/// The least of many bounds is the one that noise made small: by some 3 % where the bounds are sharpest (the
/// unit test with 400 independent kernels), the share of a bias still to come by as much.
constexpr double choosers_margin = 1.1;

/// At a jump 2^(-1/4) = 0.84 of the bias remains; more would be no convergence. Noise gets some room.
constexpr double jump_share = 0.87;

/// A share above that is one of no smooth field whose features the kernels resolve.
constexpr double slowest_smooth = 0.6;

/// Changes are looked at from the widest kernel on, where noise hides least. The share is the last one seen,
/// or that over the last few steps where noise made the last one look better.
/// @in    smooth: known not to jump
std::optional<Decay> decay_of(const std::vector<Change>& changes, int order, bool smooth) {
  constexpr std::size_t few = 3;
  std::optional<Decay> decay;
  for (std::size_t k = 0; k < changes.size() && changes[k].stands_out; ++k) {
    double share = k > 0 ? 0.0 : smooth ? slowest_smooth : jump_share;
    for (std::size_t steps = 1; steps <= std::min(k, few); ++steps)
      share = std::max(share,
                       std::pow(changes[k].seen / changes[k - steps].seen, 1.0 / static_cast<double>(steps)));
    // Slower than any smooth field: a jump, whose share noise must not make smaller.
    const std::size_t back = std::min(k, few);
    const double mean =
        back == 0 ? 0.0 : std::pow(changes[k].seen / changes[k - back].seen, 1.0 / static_cast<double>(back));
    decay = Decay{k, share > slowest_smooth ? jump_share : std::max(share, smooth_share(order)),
                  std::clamp(mean, smooth_share(order), jump_share)};
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

/// A variance between levels, and beyond the widest: by as much a level as between the two widest, but no
/// less than for random photons, whose variance goes as 1 / photons, and no more than measured of the
/// evenest, Sobol points under a wide kernel on a smooth field.
double variance_at(const std::vector<double>& by_level, double level) {
  const auto at = [&](std::size_t i) { return std::log2(std::max(by_level[i], 1e-300)); };
  if (level <= 0) {
    const double a_level = by_level.size() > 1 ? std::clamp(at(1) - at(0), 1.0, 2.5) : 1.0;
    return by_level.front() * std::exp2(a_level * level);
  }
  const double last = static_cast<double>(by_level.size() - 1);
  const auto below = static_cast<std::size_t>(std::min(level, last));
  const double part = std::min(level, last) - static_cast<double>(below);
  return std::exp2((1 - part) * at(below) + part * at(std::min(below + 1, by_level.size() - 1)));
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

LadderSummary summary_of(const BandwidthLadder& ladder, bool smooth, std::span<const double> shares,
                         const LadderPhotons& photons) {
  CATOPTRIC_EXPECTS(ladder.size() >= 2 && ladder.front().second.size() >= 2);
  const std::size_t samples = ladder.front().second.front().size();
  CATOPTRIC_EXPECTS(shares.empty() || shares.size() == samples);
  std::vector<double> equal;
  if (shares.empty()) shares = equal = std::vector<double>(samples, 1 / static_cast<double>(samples));
  LadderSummary summary;
  summary.smooth = smooth;
  for (std::size_t level = 0; level < ladder.size(); ++level) {
    const LadderLevel& at = ladder[level];
    LadderSummary::Level& read = summary.levels.emplace_back();
    read.excess = excess(at.independent, at.second.size());
    read.unseen = unseen_square(at, shares, photons);
    for (std::size_t i = 0; i < orders.size(); ++i) {
      const SetFields& sets = fields_of(at, orders[i]);
      read.orders[i].variance = mean_square(sets, nullptr, shares).variance;
      if (level + 1 == ladder.size()) continue;
      const MeanSquare change = mean_square(sets, &fields_of(ladder[level + 1], orders[i]), shares);
      read.orders[i].change = change.value;
      read.orders[i].change_variance = change.variance;
    }
  }
  return summary;
}

LadderChoice best_choice(const LadderSummary& ladder) {
  LadderChoice best;
  best.error95 = HUGE_VAL;
  double seen_share = 0;  // of the second order's changes, if they stand out
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const int order = orders[i];
    const std::vector<Change> changes = changes_of(ladder, i);
    const auto decay = decay_of(changes, order, ladder.smooth);
    // What is a jump to a kernel of second order is one to a kernel of fourth; where nothing is seen of the
    // field, it may have jumps.
    double least_share = smooth_share(order);
    if (seen_share > slowest_smooth) least_share = seen_share;
    if (!decay && seen_share == 0 && !ladder.smooth) least_share = jump_share;
    for (std::size_t level = 0; level < changes.size(); ++level) {
      const double variance = ladder.levels[level].orders[i].variance;
      LadderChoice choice{level, order, std::sqrt(variance), bias_bound(changes, level, decay, least_share),
                          0};
      const LadderSummary::Level& at = ladder.levels[level];
      choice.error95 =
          choosers_margin * std::sqrt(variance * at.excess + choice.bias * choice.bias + at.unseen);
      if (choice.error95 < best.error95) best = choice;
    }
    if (decay) seen_share = decay->share;
  }
  return best;
}

LadderSummary expected_with(const LadderSummary& ladder, double times_the_photons) {
  const double shift = std::log2(times_the_photons);
  LadderSummary expected = ladder;
  // Down to the same photons in the narrowest kernel; on ever more kernels than today's the excess is less.
  for (double more = shift; more >= 1; --more) expected.levels.push_back(ladder.levels.back());
  for (auto& level : expected.levels) level.unseen /= times_the_photons * times_the_photons;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const std::vector<Change> changes = changes_of(ladder, i);
    const auto decay = decay_of(changes, orders[i], ladder.smooth);
    std::vector<double> variances, change_variances;
    for (const auto& level : ladder.levels) {
      variances.push_back(level.orders[i].variance);
      change_variances.push_back(level.orders[i].change_variance);
    }
    change_variances.pop_back();
    for (std::size_t level = 0; level < expected.levels.size(); ++level) {
      const double as_today = static_cast<double>(level) - shift;
      double seen = decay && level <= decay->level ? changes[level].seen : 0;
      if (decay && level > decay->level)
        seen = changes[decay->level].seen *
               std::pow(decay->likely_share, static_cast<double>(level - decay->level));
      LadderReading& reading = expected.levels[level].orders[i];
      const auto expect = [&](const std::vector<double>& today) {
        const double same_kernel = level < today.size() ? today[level] / times_the_photons : HUGE_VAL;
        return std::min(variance_at(today, as_today), same_kernel);
      };
      reading.variance = expect(variances);
      reading.change_variance = expect(change_variances);
      reading.change = seen * seen + reading.change_variance;
    }
  }
  return expected;
}

}  // namespace catoptric::sim
