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
Errors errors_at(const RingDensities& densities, std::span<const double> powers) {
  const std::size_t places = densities.second_square.size();
  const double share = 1 / static_cast<double>(places);
  Errors errors;
  for (std::size_t i = 0; i < places; ++i) {
    const RingEstimate at = ring_estimate(densities, i, powers);
    errors.variance += share * at.second_variance;
    errors.bias_square +=
        share * ((at.second - at.fourth) * (at.second - at.fourth) - at.difference_variance);
  }
  errors.bias_square = std::max(0.0, errors.bias_square);
  return errors;
}

/// Even in r^2, which is even by area.
std::array<double, 32> places_over(double cover) {
  std::array<double, 32> places;
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = cover * (static_cast<double>(i) + 0.5) / static_cast<double>(places.size());
  return places;
}

}  // namespace

RingEstimate ring_estimate(const RingDensities& densities, std::size_t place,
                           std::span<const double> powers) {
  const std::size_t sets = powers.size();
  const double n = static_cast<double>(sets);
  const double *second = densities.second_order.data() + place * sets,
               *fourth = densities.fourth_order.data() + place * sets;
  RingEstimate out;
  double power = 0;
  for (std::size_t i = 0; i < sets; ++i) {
    out.second += powers[i] / (pi * n) * second[i];
    out.fourth += powers[i] / (pi * n) * fourth[i];
    power += powers[i] / (pi * n * n);
  }
  out.second_poisson = power * power * densities.second_square[place];
  if (sets < 2) {
    out.second_variance = out.second_poisson;
    out.fourth_variance = power * power * densities.fourth_square[place];
    out.difference_variance = std::max(0.0, out.fourth_variance - out.second_variance);
    return out;
  }
  for (std::size_t i = 0; i < sets; ++i) {
    const double off_second = powers[i] / pi * second[i] - out.second;
    const double off_fourth = powers[i] / pi * fourth[i] - out.fourth;
    const double share = 1 / (n * (n - 1));
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
  double best = widest * cover, least_sum = std::numeric_limits<double>::infinity();
  for (double bandwidth = widest * cover; bandwidth >= least; bandwidth *= narrowing) {
    const Errors errors = errors_at(store.estimate_near(places, kernel, bandwidth), powers);
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
