#include "sim/ladder_sum.h"

#include <algorithm>
#include <cmath>

#include "base/contract.h"
#include "base/vector_clones.h"

namespace catoptric::sim {
namespace {

constexpr std::size_t lanes = LadderSum::lanes;

struct Scale {
  double x, y, per_mm2;
};

CATOPTRIC_VECTOR_CLONES
void relative_squares(const Scale& at, const double* __restrict x, const double* __restrict y,
                      std::size_t count, double* __restrict squares) {
  const Scale scale = at;
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = x[i] - scale.x, dy = y[i] - scale.y;
    squares[i] = (dx * dx + dy * dy) * scale.per_mm2;
  }
}

/// Adds (1 - t)^2 where t < 1, level by level.
CATOPTRIC_VECTOR_CLONES
void add_levels(LadderSum::Tier& tier) {
  double narrowing = tier.narrowing;
  for (std::size_t level = 0; level < tier.levels; ++level, narrowing *= 2) {
    std::array<double, lanes> sums = tier.sums[level];
    for (std::size_t i = 0; i < tier.count; i += lanes)
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const double left = 1 - narrowing * tier.squares[i + lane];
        const double within = left > 0 ? left : 0.0;
        sums[lane] += within * within;
      }
    tier.sums[level] = sums;
  }
}

/// Appends the squares below a bound to those of another tier, which has room for all.
void pass_on(const LadderSum::Tier& from, double below, LadderSum::Tier& to) {
  std::size_t count = to.count;
  for (std::size_t i = 0; i < from.count; ++i) {
    to.squares[count] = from.squares[i];
    count += from.squares[i] < below;
  }
  to.count = count;
}

}  // namespace

LadderSum::LadderSum(double widest_radius_mm, std::size_t levels)
    : per_mm2_(1 / (widest_radius_mm * widest_radius_mm)), tiers_((levels + tier_levels - 1) / tier_levels) {
  CATOPTRIC_EXPECTS(widest_radius_mm > 0 && levels > 0);
  double narrowing = 1;
  for (Tier& tier : tiers_) {
    tier.narrowing = narrowing;
    tier.levels = std::min(tier_levels, levels);
    levels -= tier.levels;
    narrowing *= std::exp2(static_cast<double>(tier_levels));
  }
}

void LadderSum::start(const StoredPhoton& centre) {
  centre_ = centre;
  for (Tier& tier : tiers_) {
    tier.count = 0;
    tier.sums = {};
  }
}

void LadderSum::add(const double* x_mm, const double* y_mm, std::size_t count) {
  Tier& first = tiers_.front();
  for (std::size_t done = 0; done < count;) {
    const std::size_t length = std::min(count - done, held - first.count);
    relative_squares({centre_.x_mm, centre_.y_mm, per_mm2_}, x_mm + done, y_mm + done, length,
                     first.squares.data() + first.count);
    first.count += length;
    done += length;
    if (first.count == held) weigh(0);
  }
}

void LadderSum::weigh(std::size_t index) {
  Tier& tier = tiers_[index];
  if (index + 1 < tiers_.size()) {
    Tier& next = tiers_[index + 1];
    if (next.count + tier.count > held) weigh(index + 1);
    pass_on(tier, 1 / next.narrowing, next);
  }
  std::fill_n(tier.squares.begin() + static_cast<std::ptrdiff_t>(tier.count), lanes, HUGE_VAL);
  add_levels(tier);
  tier.count = 0;
}

void LadderSum::weights(std::span<double> by_level) {
  std::size_t level = 0;
  for (std::size_t index = 0; index < tiers_.size(); ++index) {
    weigh(index);
    for (std::size_t i = 0; i < tiers_[index].levels; ++i) {
      double sum = 0;
      for (const double part : tiers_[index].sums[i]) sum += part;
      by_level[level++] = 3 * sum;
    }
  }
  CATOPTRIC_EXPECTS(by_level.size() == level);
}

}  // namespace catoptric::sim
