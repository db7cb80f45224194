#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/ray.h"
#include "sim/kernel.h"
#include "sim/material.h"
#include "sim/near_field.h"
#include "sim/source.h"

namespace catoptric::sim {

/// What the photons live in. Borrowed for the duration of a call.
struct Scene {
  const Source& source;
  const Reflector& reflector;
  Material mirror;
  const NearField& near_field;
};

/// Where the emission's random numbers come from.
enum class Sampler {
  random,  ///< Philox, independent numbers
  sobol,   ///< Owen-scrambled Sobol points (randomised quasi-Monte-Carlo)
};

struct PhotonOptions {
  std::uint64_t photons = 100'000;  ///< emitted towards the reflector; 0 is allowed and gives a dark field
  Sampler sampler = Sampler::random;
  std::uint64_t seed = 1;
  std::uint64_t stream = 0;  ///< another stream is another independent set of photons
  int most_interactions = 1000;
};

/// How photons become irradiance. Exactly one of the two bandwidths is set.
struct EstimateOptions {
  Kernel kernel = Kernel::silverman;
  std::optional<std::size_t>
      neighbours;  ///< paper eq. 8: the nearest N photons, r is the farthest's distance
  std::optional<double> kernel_radius_mm;  ///< all photons within a fixed radius
};

/// Where the emitted power went. The parts add up to emitted_w within 1e-12 of it.
struct EnergyLedger {
  double emitted_w = 0;   ///< into the projection map
  double missed_w = 0;    ///< met no mirror: left, or ended on the near field's own surface untouched
  double absorbed_w = 0;  ///< in the mirror
  double received_w = 0;  ///< absorbed by the near field after touching the mirror, or crossed the invisible
                          ///< near field's own area at least once and then left
  double escaped_w = 0;  ///< touched the mirror and left without meeting the near field's own area
  double cut_off_w = 0;  ///< stopped after most_interactions
};

struct PhotonCounts {
  std::uint64_t emitted = 0, met_mirror = 0, stored = 0, interactions = 0;
};

/// Irradiance at the samples, W/mm^2, in the order of the samples.
struct FieldEstimate {
  std::vector<double> direct;     ///< computed, with occlusion by the reflector
  std::vector<double> reflected;  ///< from the photon map
  std::vector<double> noise;      ///< standard deviation of `reflected` by the spread of photon weights
  std::vector<double> kernel_radius_mm;  ///< bandwidth of each estimate
  EnergyLedger energy;
  PhotonCounts counts;
};

/// Traces photons and estimates the irradiance at the samples.
/// @out   the same bits for any number of threads
/// @fails InputError when both or neither bandwidth is set, or neighbours is 0
/// @error noise falls like photons^-1/2, bias grows like the square of the kernel radius (PEERS: error laws)
/// @cost  photons times one or two intersections, a k-d tree of the stored photons, one query per sample
/// @from  paper section 4.4 and eq. 8
FieldEstimate simulate(const Scene& scene, std::span<const FieldSample> samples, const PhotonOptions& photons,
                       const EstimateOptions& estimate);

}  // namespace catoptric::sim
