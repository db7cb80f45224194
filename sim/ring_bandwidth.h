#pragma once

#include <span>
#include <vector>

#include "sim/ring_store.h"

namespace catoptric::sim {

/// What the replicates say together at one place, W/mm^2.
struct RingEstimate {
  double second = 0, fourth = 0;                    ///< means of the estimates of that order
  double second_variance = 0, fourth_variance = 0;  ///< of the means, by the replicates' spread
  double difference_variance = 0;                   ///< of second - fourth
  double second_poisson = 0;                        ///< variance of `second` for independent photons
};

/// Reads densities as irradiance.
class RingEstimator {
 public:
  /// @in  the power of a photon of each set, W
  explicit RingEstimator(std::span<const double> powers);
  RingEstimate operator()(const RingDensity& density) const;

 private:
  std::vector<double> own_, shared_;  ///< W/mm^2 of a density by set: as a field of its own, in the mean
  double power_ = 0;                  ///< of a photon in the mean, as irradiance
};

/// The bandwidth in r^2 with the least estimated mean integrated squared error over [0, cover]: the variance
/// is that of the replicates, so that Sobol points get the narrow kernels they deserve, the squared bias is
/// the squared difference to the fourth order less its own noise.
double choose_bandwidth(const RingStore& store, std::span<const double> powers, RingKernel kernel,
                        double cover);

}  // namespace catoptric::sim
