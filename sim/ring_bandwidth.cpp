#include "sim/ring_bandwidth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace catoptric::sim {
namespace {

struct Errors {
  double variance = 0, bias_square = 0;
  double sum() const { return variance + bias_square; }
};

/// Means over the places.
Errors mean_of(std::span<const RingEstimate> estimates) {
  const double share = 1 / static_cast<double>(estimates.size());
  Errors errors;
  for (const RingEstimate& at : estimates) {
    errors.variance += share * at.second_variance;
    errors.bias_square +=
        share * ((at.second - at.fourth) * (at.second - at.fourth) - at.difference_variance);
  }
  errors.bias_square = std::max(0.0, errors.bias_square);
  return errors;
}

constexpr std::size_t judged_places = 32;

/// Even in r^2, which is even by area.
std::array<double, judged_places> places_over(double cover) {
  std::array<double, judged_places> places;
  for (std::size_t i = 0; i < judged_places; ++i)
    places[i] = cover * (static_cast<double>(i) + 0.5) / static_cast<double>(judged_places);
  return places;
}

}  // namespace

RingEstimator::RingEstimator(std::span<const double> powers) {
  const double n = static_cast<double>(powers.size());
  for (double power : powers) {
    own_.push_back(power / pi);
    shared_.push_back(power / (pi * n));
    power_ += power / (pi * n * n);
  }
}

RingEstimate RingEstimator::operator()(const RingDensity& density) const {
  const std::size_t sets = own_.size();
  RingEstimate out;
  for (std::size_t i = 0; i < sets; ++i) {
    out.second += shared_[i] * density.second_order[i];
    out.fourth += shared_[i] * density.fourth_order[i];
  }
  out.second_poisson = power_ * power_ * density.second_square;
  if (sets < 2) {
    out.second_variance = out.second_poisson;
    out.fourth_variance = power_ * power_ * density.fourth_square;
    out.difference_variance = std::max(0.0, out.fourth_variance - out.second_variance);
    return out;
  }
  const double share = 1 / static_cast<double>(sets * (sets - 1));
  for (std::size_t i = 0; i < sets; ++i) {
    const double off_second = own_[i] * density.second_order[i] - out.second;
    const double off_fourth = own_[i] * density.fourth_order[i] - out.fourth;
    out.second_variance += share * off_second * off_second;
    out.fourth_variance += share * off_fourth * off_fourth;
    out.difference_variance += share * (off_second - off_fourth) * (off_second - off_fourth);
  }
  return out;
}

double choose_bandwidth(const RingStore& store, std::span<const double> powers, RingKernel kernel,
                        double cover) {
  constexpr double widest = 0.25, narrowing = 0.7;
  const double least = std::min(store.least_bandwidth(), widest * cover);
  const auto places = places_over(cover);
  const RingEstimator estimator(powers);
  std::array<RingEstimate, judged_places> estimates;
  const auto take = [&](std::size_t i, const RingDensity& density) { estimates[i] = estimator(density); };
  double best = widest * cover, least_sum = std::numeric_limits<double>::infinity();
  for (double bandwidth = widest * cover; bandwidth >= least; bandwidth *= narrowing) {
    store.estimate_near(places, kernel, bandwidth, take);
    const Errors errors = mean_of(estimates);
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
