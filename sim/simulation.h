#pragma once

#include <span>
#include <vector>

#include "sim/photon_map.h"
#include "sim/scene.h"
#include "sim/tracer.h"

namespace catoptric::sim {

/// Irradiance at the samples, W/mm^2, in the order of the samples.
struct FieldEstimate {
  std::vector<double> direct;     ///< computed, with occlusion by the reflector
  std::vector<double> reflected;  ///< from the photon map
  std::vector<double> noise;      ///< standard deviation of `reflected` by the spread of photon weights
  std::vector<double> kernel_radius_mm;  ///< bandwidth of each estimate
  EnergyLedger energy;
  PhotonCounts counts;
};

/// Irradiance straight from the source at the samples, W/mm^2, with occlusion by the reflector; 0 where a
/// sample looks away from the source.
/// @out   the same bits for any number of threads
/// @from  paper eq. 13
std::vector<double> direct_field(const Scene& scene, std::span<const FieldSample> samples);

/// Traces photons and estimates the irradiance at the samples. To judge the same photons with several
/// bandwidths, call trace_photons once with the largest margin, then PhotonMap::estimate for each.
/// @in    samples on the near field
/// @out   the same bits for any number of threads
/// @fails InputError when both or neither bandwidth is set, or neighbours is 0; as trace_photons
/// @error noise falls like photons^-1/2, bias grows like the square of the kernel radius
/// @cost  photons times one or two intersections, a grid of the stored photons, one query per sample
/// @from  paper section 4.4 and eq. 8
FieldEstimate simulate(const Scene& scene, std::span<const FieldSample> samples, const PhotonOptions& photons,
                       const EstimateOptions& estimate);

}  // namespace catoptric::sim
