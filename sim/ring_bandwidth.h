#pragma once

#include <span>

#include "sim/ring_store.h"

namespace catoptric::sim {

/// What the replicates say together at one place, W/mm^2.
struct RingEstimate {
  double second = 0, fourth = 0;                    ///< means of the estimates of that order
  double second_variance = 0, fourth_variance = 0;  ///< of the means, by the replicates' spread
  double difference_variance = 0;                   ///< of second - fourth
  double second_poisson = 0;                        ///< variance of `second` for independent photons
};

/// @in  one of the densities' places; the power of a photon of each set, W
RingEstimate ring_estimate(const RingDensities& densities, std::size_t place, std::span<const double> powers);

/// The bandwidth in r^2 with the least estimated mean integrated squared error over [0, cover]: the variance
/// is that of the replicates, so that Sobol points get the narrow kernels they deserve, the squared bias is
/// the squared difference to the fourth order less its own noise.
double choose_bandwidth(const RingStore& store, std::span<const double> powers, RingKernel kernel,
                        double cover);

}  // namespace catoptric::sim
