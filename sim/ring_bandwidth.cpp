#include "sim/ring_bandwidth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace catoptric::sim {
namespace {

struct Errors {
  double variance = 0, bias_square = 0;
  double sum() const { return variance + bias_square; }
};

/// Means over places even in r^2, which is even by area.
Errors errors_with(RingStore& store, std::span<const double> powers, RingKernel kernel, double cover,
                   double bandwidth) {
  constexpr int places = 32;
  store.prepare(bandwidth);
  RingDensities densities;
  Errors errors;
  for (int i = 0; i < places; ++i) {
    store.estimate(cover * (i + 0.5) / places, kernel, bandwidth, densities);
    const RingEstimate at = ring_estimate(densities, powers);
    errors.variance += at.second_variance / places;
    errors.bias_square +=
        ((at.second - at.fourth) * (at.second - at.fourth) - at.difference_variance) / places;
  }
  errors.bias_square = std::max(0.0, errors.bias_square);
  return errors;
}

}  // namespace

RingEstimate ring_estimate(const RingDensities& densities, std::span<const double> powers) {
  const std::size_t sets = powers.size();
  const double n = static_cast<double>(sets);
  RingEstimate out;
  double power = 0;
  for (std::size_t i = 0; i < sets; ++i) {
    out.second += powers[i] / (pi * n) * densities.second_order[i];
    out.fourth += powers[i] / (pi * n) * densities.fourth_order[i];
    power += powers[i] / (pi * n * n);
  }
  out.second_poisson = power * power * densities.second_square;
  if (sets < 2) {
    out.second_variance = out.second_poisson;
    out.fourth_variance = power * power * densities.fourth_square;
    out.difference_variance = std::max(0.0, out.fourth_variance - out.second_variance);
    return out;
  }
  for (std::size_t i = 0; i < sets; ++i) {
    const double off_second = powers[i] / pi * densities.second_order[i] - out.second;
    const double off_fourth = powers[i] / pi * densities.fourth_order[i] - out.fourth;
    const double share = 1 / (n * (n - 1));
    out.second_variance += share * off_second * off_second;
    out.fourth_variance += share * off_fourth * off_fourth;
    out.difference_variance += share * (off_second - off_fourth) * (off_second - off_fourth);
  }
  return out;
}

double choose_bandwidth(RingStore& store, std::span<const double> powers, RingKernel kernel, double cover) {
  constexpr double widest = 0.25, narrowing = 0.7;
  const double least = std::min(store.least_bandwidth(), widest * cover);
  double best = widest * cover, least_sum = std::numeric_limits<double>::infinity();
  for (double bandwidth = widest * cover; bandwidth >= least; bandwidth *= narrowing) {
    const Errors errors = errors_with(store, powers, kernel, cover, bandwidth);
    if (errors.sum() < least_sum) {
      least_sum = errors.sum();
      best = bandwidth;
    }
    // The variance only grows from here on.
    if (errors.variance > least_sum) break;
  }
  return best;
}

}  // namespace catoptric::sim
