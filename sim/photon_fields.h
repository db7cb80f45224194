#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/photon_map.h"
#include "sim/scene.h"
#include "sim/tracer.h"

namespace catoptric::sim {

/// Photons whose map is held at a time where the bandwidth is a fixed radius: 0.6 GB.
inline constexpr std::uint64_t photons_of_a_batch = std::uint64_t{1} << 24;
static_assert(photons_of_a_batch % photons_of_a_chunk == 0);

/// Most memory of a photon in flight and map, as the system counts it: of 1e8 photons 33.4 bytes each were
/// seen. (The map's own need is 20; but blocks that chunks of photons gave back are too small for it to use
/// again.)
inline constexpr std::uint64_t bytes_of_a_stored_photon = 36;

/// What one set of photons says under several bandwidths.
struct PhotonFields {
  std::vector<MapEstimate> estimates;  ///< one for each bandwidth
  EnergyLedger energy;
  PhotonCounts counts;
};

/// Rung "photons" from flight to irradiance. With fixed radii an estimate is a sum over photons, so that they
/// are traced, mapped, summed and forgotten batch after batch: any number of photons in the same memory. The
/// nearest N are only known when all are there.
/// @in    samples on the near field; at least one bandwidth; batch: a multiple of photons_of_a_chunk
/// @out   the same bits for any number of threads and ranks; those of one map where a batch holds all photons
/// @fails as trace_photons and PhotonMap::estimate
/// @cost  as these; memory as photon_memory_bytes()
PhotonFields photon_fields(const Scene& scene, std::span<const FieldSample> samples,
                           const PhotonOptions& photons, std::span<const EstimateOptions> bandwidths,
                           std::uint64_t batch = photons_of_a_batch);

/// The same of several independent sets, set i on stream + i. The ranks of `photons` share the batches of
/// all.
std::vector<PhotonFields> photon_fields_of_sets(const Scene& scene, std::span<const FieldSample> samples,
                                                const PhotonOptions& photons,
                                                std::span<const EstimateOptions> bandwidths,
                                                std::uint64_t sets, std::uint64_t batch = photons_of_a_batch);

/// Into how many batches photon_fields() cuts so many photons.
/// @in fields  where irradiance is asked for, the near field counted
std::uint64_t photon_batches(std::uint64_t photons, std::span<const EstimateOptions> bandwidths,
                             std::size_t fields);

/// Most memory that the photons of photon_fields() take, flight and map together, when each meets the near
/// field's plane once. (In a cavity one photon may meet it many times.)
std::uint64_t photon_memory_bytes(std::uint64_t photons, const EstimateOptions& bandwidth);

}  // namespace catoptric::sim
