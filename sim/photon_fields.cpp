#include "sim/photon_fields.h"

#include <algorithm>
#include <cmath>

#include "base/contract.h"

namespace catoptric::sim {
namespace {

/// Adds what another batch of the same set gives; powers of all photons are those of the whole set.
void add(MapEstimate& sum, MapEstimate part) {
  if (sum.irradiance.empty()) {
    sum = std::move(part);
    return;
  }
  for (std::size_t i = 0; i < sum.irradiance.size(); ++i) {
    sum.irradiance[i] += part.irradiance[i];
    sum.noise[i] = std::hypot(sum.noise[i], part.noise[i]);
    sum.photons[i] += part.photons[i];
  }
}

bool all_by_radius(std::span<const EstimateOptions> bandwidths) {
  return std::ranges::none_of(bandwidths,
                              [](const EstimateOptions& each) { return each.neighbours.has_value(); });
}

}  // namespace

PhotonFields photon_fields(const Scene& scene, std::span<const FieldSample> samples,
                           const PhotonOptions& photons, std::span<const EstimateOptions> bandwidths,
                           std::uint64_t batch) {
  CATOPTRIC_EXPECTS(!bandwidths.empty() && batch > 0 && batch % photons_of_a_chunk == 0);
  double margin_mm = 0;
  for (const EstimateOptions& each : bandwidths) {
    check(each);
    margin_mm = std::max(margin_mm, recording_margin_mm(scene.near_field, each));
  }
  check(photons);
  const PhotonFlights flights(scene, RecordedArea::about(scene.near_field, margin_mm));
  const std::uint64_t chunks = PhotonFlights::chunks(photons.photons);
  const std::uint64_t at_once =
      all_by_radius(bandwidths) ? std::min(chunks, batch / photons_of_a_chunk) : chunks;
  const std::uint64_t chunks_of_a_batch = std::max<std::uint64_t>(1, at_once);
  PhotonFields fields{std::vector<MapEstimate>(bandwidths.size()), {}, {}};
  TracedPhotons landed;
  const auto begin_batch = [&] {
    landed.area = flights.area();
    landed.photon_power_w = flights.photon_power_w(photons.photons);
    landed.chunks.assign(at_once, {});
  };
  begin_batch();
  const FlightTotals totals = flights.fly(
      photons,
      [&](std::uint64_t i, std::vector<Crossing>&& crossings) {
        landed.chunks[i % chunks_of_a_batch] = store(crossings, landed.area);
      },
      chunks_of_a_batch,
      [&] {
        const PhotonMap map(scene.near_field, std::move(landed));
        for (std::size_t i = 0; i < bandwidths.size(); ++i)
          add(fields.estimates[i], map.estimate(samples, bandwidths[i]));
        begin_batch();
      });
  fields.energy = totals.energy;
  fields.counts = totals.counts;
  return fields;
}

std::uint64_t photon_memory_bytes(std::uint64_t photons, const EstimateOptions& bandwidth) {
  return bytes_of_a_stored_photon * (bandwidth.neighbours ? photons : std::min(photons, photons_of_a_batch));
}

}  // namespace catoptric::sim
