#include "sim/tracer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/contract.h"
#include "base/profile.h"
#include "base/random_stream.h"
#include "base/tolerance.h"
#include "sim/flight_counts.h"
#include "sim/opening.h"
#include "sim/photon_tracer.h"
#include "sim/plane_tracer.h"
#include "sim/projection_map.h"
#include "sim/scatter.h"
#include "sim/side_by_side.h"
#include "sim/turns.h"

namespace catoptric::sim {

void check(const PhotonOptions& options) {
  if (options.photons > most_photons)
    throw InputError({fmt::format("{} photons", options.photons), "",
                      fmt::format("one set holds at most {}", most_photons),
                      "average several sets of another stream"});
  if (options.most_interactions < 1)
    throw InputError({fmt::format("most_interactions is {}", options.most_interactions), "",
                      "a photon must be allowed to meet the mirror once", "1000 is usual"});
}

void give_up_if_stopped(const PhotonOptions& options) {
  if (options.stop && options.stop->load(std::memory_order_relaxed)) throw Interrupted();
}

namespace {

/// Where a source stands in a body of glass, its light starts there; photons here start in air.
void require_air_round_source(const Scene& scene) {
  if (const auto body = scene.surroundings->body_around(scene.source.position_mm()))
    throw InputError({"the source is inside it", scene.surroundings->objects()[*body].name,
                      "light that starts in glass is not modelled", "move the source or the glass"});
}

}  // namespace

std::unique_ptr<const Emission> emission_of(const Scene& scene) {
  if (auto defect = find_defect(scene.mirror)) {
    defect->where = "mirror";
    throw InputError(std::move(*defect));
  }
  if (scene.surroundings) require_air_round_source(scene);
  if (sends_everywhere(scene)) return scene.source.emission();
  return scene.source.emission_to(scene.reflector.profile());
}

double first_share(const Scene& scene) {
  return is_recorded_without_mirror(scene) ? 1 : surviving_share(scene.mirror);
}

struct PhotonFlights::Parts {
  Scene scene;
  RecordedArea area;
  std::vector<RecordedArea> more;  ///< of the surroundings' fields
  std::unique_ptr<const Emission> emission;
  std::optional<Opening> opening;
  double lift_mm;
  std::optional<PlaneScene> plane;  ///< where no photon leaves its meridian plane

  ChunkResult trace(const PhotonOptions& options, std::uint64_t key, std::uint64_t first,
                    std::uint64_t last) const {
    if (plane) return trace_in_plane(options, key, first, static_cast<std::size_t>(last - first));
    const Surroundings* const room = scene.is_bare() ? nullptr : scene.surroundings;
    return trace_in_space({scene, options, *emission, area, opening, key, lift_mm, false, room, &more}, first,
                          last);
  }

  ChunkResult trace_in_plane(const PhotonOptions& options, std::uint64_t key, std::uint64_t first,
                             std::size_t count) const {
    std::array<double, photons_of_a_chunk> polar, azimuth, cosine, azimuth_cosine, azimuth_sine;
    const auto row = [count](auto& array) { return std::span(array.data(), count); };
    EmissionNumbers(options.sampler, key).draw(first, std::array{row(polar), row(azimuth)});
    emission->directions()->cosines(row(polar), row(cosine));
    cosines_and_sines(row(azimuth), row(azimuth_cosine), row(azimuth_sine));
    PlaneTracer tracer(*plane, options.most_interactions, key);
    tracer.trace(first, {row(cosine), row(azimuth_cosine), row(azimuth_sine)});
    return {std::move(tracer.crossings()), {}, tracer.counts()};
  }
};

PhotonFlights::PhotonFlights(const Scene& scene, const RecordedArea& area, FlightSpace space)
    : parts_(new Parts{scene,
                       area,
                       {},
                       emission_of(scene),
                       Opening::of(scene.reflector.profile()),
                       Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm,
                       {}}) {
  if (space == FlightSpace::as_needed && PlaneScene::possible(scene)) parts_->plane.emplace(scene, area);
}
PhotonFlights::PhotonFlights(const Scene& scene, const RecordedArea& area, std::vector<RecordedArea> more)
    : PhotonFlights(scene, area) {
  CATOPTRIC_EXPECTS(more.size() == (scene.surroundings ? scene.surroundings->fields().size() : 0));
  parts_->more = std::move(more);
}
PhotonFlights::~PhotonFlights() = default;

void PhotonFlights::record(const RecordedArea& area) {
  parts_->area = area;
  if (parts_->plane) parts_->plane->area = area;
}

const RecordedArea& PhotonFlights::area() const { return parts_->area; }

std::uint64_t PhotonFlights::chunks(std::uint64_t photons) {
  return photons / photons_of_a_chunk + (photons % photons_of_a_chunk != 0);
}

FlightTotals PhotonFlights::fly(const PhotonOptions& options, const TakeCrossings& take) const {
  return totals(options.photons, fly_chunks(options, take, 0, chunks(options.photons)));
}

double PhotonFlights::photon_power_w(std::uint64_t photons) const {
  return totals(photons, {}).photon_power_w;
}

FlightCounts PhotonFlights::fly_chunks(const PhotonOptions& options, const TakeCrossings& take,
                                       std::uint64_t first, std::uint64_t end) const {
  check(options);
  const std::uint64_t key = photon_key(options.seed, options.stream);
  const std::uint64_t photons = options.photons;
  SharedCounts counts;
  side_by_side(end - first, [&](std::uint64_t i) {
    give_up_if_stopped(options);
    const std::uint64_t chunk = first + i, photon = chunk * photons_of_a_chunk;
    ChunkResult result = parts_->trace(options, key, photon, std::min(photon + photons_of_a_chunk, photons));
    counts.add(result.counts);
    take(chunk, std::move(result.crossings));
  });
  return counts.counted();
}

FlightTotals PhotonFlights::totals(std::uint64_t photons, const FlightCounts& counted) const {
  SharedCounts counts;
  counts.add(counted);
  return counts.totals(photons, parts_->emission->power_w(), first_share(parts_->scene));
}

FlightTotals depart(const Scene& scene, const PhotonOptions& options, const TakeDepartures& take) {
  check(options);
  if (auto defect = find_defect(scene.mirror)) {
    defect->where = "mirror";
    throw InputError(std::move(*defect));
  }
  const Surroundings luminaire = scene.surroundings ? scene.surroundings->luminaire() : Surroundings();
  const Surroundings* const room = luminaire.is_empty() ? nullptr : &luminaire;
  const std::vector<RecordedArea> none;
  const auto emission = scene.source.emission();
  const auto opening = Opening::of(scene.reflector.profile());
  const RecordedArea nowhere = RecordedArea::about(scene.near_field, 0);
  const std::uint64_t key = photon_key(options.seed, options.stream);
  const double lift_mm = Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm;
  SharedCounts counts;
  side_by_side(PhotonFlights::chunks(options.photons), [&](std::uint64_t i) {
    give_up_if_stopped(options);
    const std::uint64_t first = i * photons_of_a_chunk;
    const ChunkResult chunk =
        trace_in_space({scene, options, *emission, nowhere, opening, key, lift_mm, true, room, &none}, first,
                       std::min(first + photons_of_a_chunk, options.photons));
    counts.add(chunk.counts);
    take(i, chunk.departures);
  });
  return counts.totals(options.photons, emission->power_w(), 1);
}

StoredChunk store(std::span<const Crossing> crossings, const RecordedArea& area, std::size_t field) {
  const BandOf band_of(area);
  std::array<std::array<std::size_t, photon_bands>, 2> counts{};
  for (const Crossing& crossing : crossings)
    if (crossing.field() == field) ++counts[crossing.from_front()][band_of(crossing.y_mm)];
  StoredChunk chunk;
  for (std::size_t band = 0; band < photon_bands; ++band) {
    chunk.front[band].reserve(counts[1][band]);
    chunk.back[band].reserve(counts[0][band]);
  }
  for (const Crossing& crossing : crossings)
    if (crossing.field() == field)
      (crossing.from_front() ? chunk.front : chunk.back)[band_of(crossing.y_mm)].push_back(
          {crossing.x_mm, crossing.y_mm});
  return chunk;
}

TracedPhotons trace_chunks(const PhotonFlights& flights, const PhotonOptions& options, std::uint64_t first,
                           std::uint64_t end, FlightCounts& counted) {
  TracedPhotons traced;
  traced.area = flights.area();
  traced.photon_power_w = flights.photon_power_w(options.photons);
  traced.chunks.resize(end - first);
  counted = flights.fly_chunks(
      options,
      [&](std::uint64_t i, std::vector<Crossing>&& crossings) {
        traced.chunks[i - first] = store(crossings, traced.area);
      },
      first, end);
  return traced;
}

TracedPhotons trace_photons(const Scene& scene, const PhotonOptions& options, double margin_mm) {
  check(options);
  const PhotonFlights flights(scene, RecordedArea::about(scene.near_field, margin_mm));
  FlightCounts counted;
  TracedPhotons traced = trace_chunks(flights, options, 0, PhotonFlights::chunks(options.photons), counted);
  const FlightTotals totals = flights.totals(options.photons, counted);
  traced.energy = totals.energy;
  traced.counts = totals.counts;
  return traced;
}

}  // namespace catoptric::sim
