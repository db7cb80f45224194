#include "sim/photon_fields.h"

#include <algorithm>
#include <cmath>

#include "base/contract.h"
#include "sim/facet_estimate.h"

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

/// One of the surfaces where irradiance is asked for, with its samples.
struct FieldPart {
  const NearField& field;
  std::vector<EstimateOptions> bandwidths;
  RecordedArea area;
  std::vector<std::size_t> places;  ///< of its samples among all
  std::vector<FieldSample> samples;
  TracedPhotons landed;
};

EstimateOptions scaled(EstimateOptions bandwidth, double scale) {
  if (bandwidth.kernel_radius_mm) *bandwidth.kernel_radius_mm *= scale;
  return bandwidth;
}

FieldPart part_of(const NearField& field, double kernel_scale, std::span<const EstimateOptions> bandwidths) {
  FieldPart part{field, {}, {}, {}, {}, {}};
  double margin_mm = 0;
  for (const EstimateOptions& each : bandwidths) {
    part.bandwidths.push_back(scaled(each, kernel_scale));
    margin_mm = std::max(margin_mm, recording_margin_mm(field, part.bandwidths.back()));
  }
  part.area = RecordedArea::about(field, margin_mm);
  return part;
}

std::vector<FieldPart> parts_of(const Scene& scene, std::span<const FieldSample> samples,
                                std::span<const EstimateOptions> bandwidths) {
  std::vector<FieldPart> parts{part_of(scene.near_field, 1, bandwidths)};
  if (scene.surroundings)
    for (const MoreField& more : scene.surroundings->fields())
      parts.push_back(part_of(more.field, more.kernel_scale, bandwidths));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    CATOPTRIC_EXPECTS(samples[i].field < parts.size());
    parts[samples[i].field].places.push_back(i);
    parts[samples[i].field].samples.push_back(samples[i]);
  }
  return parts;
}

/// Puts a part's estimates where its samples are among all.
void put(const MapEstimate& part, std::span<const std::size_t> places, MapEstimate& all) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    all.irradiance[places[i]] = part.irradiance[i];
    all.noise[places[i]] = part.noise[i];
    all.kernel_radius_mm[places[i]] = part.kernel_radius_mm[i];
    all.photons[places[i]] = part.photons[i];
  }
}

MapEstimate of_size(std::size_t size) {
  return {std::vector<double>(size), std::vector<double>(size), std::vector<double>(size),
          std::vector<std::size_t>(size)};
}

}  // namespace

PhotonFields photon_fields(const Scene& scene, std::span<const FieldSample> samples,
                           const PhotonOptions& photons, std::span<const EstimateOptions> bandwidths,
                           std::uint64_t batch) {
  CATOPTRIC_EXPECTS(!bandwidths.empty() && batch > 0 && batch % photons_of_a_chunk == 0);
  for (const EstimateOptions& each : bandwidths) check(each);
  check(photons);
  std::vector<FieldPart> parts = parts_of(scene, samples, bandwidths);
  std::vector<RecordedArea> more;
  for (std::size_t i = 1; i < parts.size(); ++i) more.push_back(parts[i].area);
  const PhotonFlights flights(scene, parts.front().area, std::move(more));
  const std::uint64_t chunks = PhotonFlights::chunks(photons.photons);
  const std::uint64_t at_once =
      all_by_radius(bandwidths) ? std::min(chunks, batch / photons_of_a_chunk / parts.size()) : chunks;
  const std::uint64_t chunks_of_a_batch = std::max<std::uint64_t>(1, at_once);
  PhotonFields fields{std::vector<MapEstimate>(bandwidths.size()), {}, {}};
  const auto begin_batch = [&] {
    for (FieldPart& part : parts) {
      part.landed.area = part.area;
      part.landed.photon_power_w = flights.photon_power_w(photons.photons);
      part.landed.chunks.assign(at_once, {});
    }
  };
  begin_batch();
  const FlightTotals totals = flights.fly(
      photons,
      [&](std::uint64_t i, std::vector<Crossing>&& crossings) {
        for (std::size_t field = 0; field < parts.size(); ++field)
          parts[field].landed.chunks[i % chunks_of_a_batch] = store(crossings, parts[field].area, field);
      },
      chunks_of_a_batch,
      [&] {
        std::vector<MapEstimate> batch_estimates(bandwidths.size(), of_size(samples.size()));
        for (FieldPart& part : parts) {
          if (const FacetField* facets = part.field.facets()) {
            for (std::size_t i = 0; i < bandwidths.size(); ++i)
              put(estimate_on_facets(*facets, part.landed, part.samples, part.bandwidths[i]), part.places,
                  batch_estimates[i]);
            continue;
          }
          const PhotonMap map(part.field, std::move(part.landed));
          for (std::size_t i = 0; i < bandwidths.size(); ++i)
            put(map.estimate(part.samples, part.bandwidths[i]), part.places, batch_estimates[i]);
        }
        for (std::size_t i = 0; i < bandwidths.size(); ++i)
          add(fields.estimates[i], std::move(batch_estimates[i]));
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
