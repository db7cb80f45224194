#include "sim/photon_fields.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/byte_record.h"
#include "base/contract.h"
#include "sim/facet_estimate.h"
#include "sim/flight_counts.h"

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

/// What the photons of a batch, or of several, give.
struct BatchFields {
  std::vector<MapEstimate> estimates;
  FlightCounts counts;
};

void put(ByteWriter& writer, const BatchFields& fields) {
  writer.put(fields.counts);
  for (const MapEstimate& each : fields.estimates)
    writer.put(each.irradiance).put(each.noise).put(each.kernel_radius_mm).put(each.photons);
}

void get(ByteReader& reader, BatchFields& fields) {
  reader.get(fields.counts);
  for (MapEstimate& each : fields.estimates)
    reader.get(each.irradiance).get(each.noise).get(each.kernel_radius_mm).get(each.photons);
}

/// Estimates from photons that have landed, which are used up.
std::vector<MapEstimate> estimates(std::vector<FieldPart>& parts, std::size_t bandwidths,
                                   std::size_t samples) {
  std::vector<MapEstimate> all(bandwidths, of_size(samples));
  for (FieldPart& part : parts) {
    if (const FacetField* facets = part.field.facets()) {
      for (std::size_t i = 0; i < bandwidths; ++i)
        put(estimate_on_facets(*facets, part.landed, part.samples, part.bandwidths[i]), part.places, all[i]);
      continue;
    }
    const PhotonMap map(part.field, std::move(part.landed));
    for (std::size_t i = 0; i < bandwidths; ++i)
      put(map.estimate(part.samples, part.bandwidths[i]), part.places, all[i]);
  }
  return all;
}

/// Chunks of photons whose map is held at a time.
std::uint64_t chunks_at_once(std::uint64_t chunks, std::uint64_t batch,
                             std::span<const EstimateOptions> bandwidths, std::size_t fields) {
  const std::uint64_t at_once =
      all_by_radius(bandwidths) ? std::min(chunks, batch / photons_of_a_chunk / fields) : chunks;
  return std::max<std::uint64_t>(1, at_once);
}

}  // namespace

std::vector<PhotonFields> photon_fields_of_sets(const Scene& scene, std::span<const FieldSample> samples,
                                                const PhotonOptions& photons,
                                                std::span<const EstimateOptions> bandwidths,
                                                std::uint64_t sets, std::uint64_t batch) {
  CATOPTRIC_EXPECTS(!bandwidths.empty() && batch > 0 && batch % photons_of_a_chunk == 0);
  for (const EstimateOptions& each : bandwidths) check(each);
  check(photons);
  std::vector<FieldPart> parts = parts_of(scene, samples, bandwidths);
  std::vector<RecordedArea> more;
  for (std::size_t i = 1; i < parts.size(); ++i) more.push_back(parts[i].area);
  const PhotonFlights flights(scene, parts.front().area, std::move(more));
  const std::uint64_t chunks = PhotonFlights::chunks(photons.photons);
  const std::uint64_t at_once = chunks_at_once(chunks, batch, bandwidths, parts.size());
  const std::uint64_t batches = std::max<std::uint64_t>(1, (chunks + at_once - 1) / at_once);
  const auto of_batch = [&](std::uint64_t set, std::uint64_t number) {
    for (FieldPart& part : parts) {
      part.landed.area = part.area;
      part.landed.photon_power_w = flights.photon_power_w(photons.photons);
      part.landed.chunks.assign(at_once, {});
    }
    PhotonOptions of_set = photons;
    of_set.stream += set;
    const std::uint64_t first = number * at_once;
    const FlightCounts counts = flights.fly_chunks(
        of_set,
        [&](std::uint64_t i, std::vector<Crossing>&& crossings) {
          for (std::size_t field = 0; field < parts.size(); ++field)
            parts[field].landed.chunks[i - first] = store(crossings, parts[field].area, field);
        },
        first, std::min(chunks, first + at_once));
    return BatchFields{estimates(parts, bandwidths.size(), samples.size()), counts};
  };
  const BatchFields none{std::vector<MapEstimate>(bandwidths.size()), {}};
  std::vector<BatchFields> sums(sets, none);
  const auto add_batch = [&](std::uint64_t set, BatchFields part) {
    for (std::size_t i = 0; i < bandwidths.size(); ++i)
      add(sums[set].estimates[i], std::move(part.estimates[i]));
    sums[set].counts.add(part.counts);
  };
  const std::uint64_t tasks = sets * batches;
  if (photons.ranks && !photons.ranks->is_alone()) {
    const auto compute = [&](std::size_t task) {
      ByteWriter writer;
      put(writer, of_batch(task / batches, task % batches));
      return writer.take();
    };
    const auto take = [&](std::size_t task, const Bytes& result) {
      BatchFields part = none;
      ByteReader reader(result);
      get(reader, part);
      add_batch(task / batches, std::move(part));
    };
    const Bytes all = photons.ranks->join(tasks, compute, take, [&] {
      ByteWriter writer;
      for (BatchFields& sum : sums) put(writer, std::exchange(sum, none));
      return writer.take();
    });
    ByteReader reader(all);
    for (BatchFields& sum : sums) get(reader, sum);
  } else {
    for (std::uint64_t task = 0; task < tasks; ++task)
      add_batch(task / batches, of_batch(task / batches, task % batches));
  }
  std::vector<PhotonFields> fields;
  for (BatchFields& sum : sums) {
    const FlightTotals totals = flights.totals(photons.photons, sum.counts);
    fields.push_back({std::move(sum.estimates), totals.energy, totals.counts});
  }
  return fields;
}

PhotonFields photon_fields(const Scene& scene, std::span<const FieldSample> samples,
                           const PhotonOptions& photons, std::span<const EstimateOptions> bandwidths,
                           std::uint64_t batch) {
  return std::move(photon_fields_of_sets(scene, samples, photons, bandwidths, 1, batch).front());
}

std::uint64_t photon_batches(std::uint64_t photons, std::span<const EstimateOptions> bandwidths,
                             std::size_t fields) {
  const std::uint64_t chunks = PhotonFlights::chunks(photons);
  const std::uint64_t at_once = chunks_at_once(chunks, photons_of_a_batch, bandwidths, fields);
  return std::max<std::uint64_t>(1, (chunks + at_once - 1) / at_once);
}

std::uint64_t photon_memory_bytes(std::uint64_t photons, const EstimateOptions& bandwidth) {
  return bytes_of_a_stored_photon * (bandwidth.neighbours ? photons : std::min(photons, photons_of_a_batch));
}

}  // namespace catoptric::sim
