#include "sim/tracer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/profile.h"
#include "base/random_stream.h"
#include "base/tolerance.h"
#include "sim/flight_counts.h"
#include "sim/opening.h"
#include "sim/projection_map.h"
#include "sim/scatter.h"

namespace catoptric::sim {
namespace {

struct ChunkResult {
  std::vector<Crossing> crossings;
  FlightCounts counts;
};

/// What every task of a set shares.
struct Flight {
  const Scene& scene;
  const PhotonOptions& options;
  const ProjectionMap& map;
  const RecordedArea& area;
  const std::optional<Opening>& opening;
  std::uint64_t key;
  double lift_mm;
};

/// Traces one chunk of photons with a probe of its own.
class PhotonTracer {
 public:
  explicit PhotonTracer(const Flight& flight)
      : flight_(flight), field_(flight.scene.near_field), probe_(flight.scene.reflector.probe()) {}

  ChunkResult trace(std::uint64_t first, std::uint64_t last) {
    result_ = {};
    const auto numbers = EmissionNumbers::starting_at(flight_.options.sampler, flight_.key, first);
    for (std::uint64_t photon = first; photon < last; ++photon) {
      const Fate fate = follow(photon, flight_.scene.source.emit(flight_.map, numbers->next()));
      ++result_.counts.ended[static_cast<std::size_t>(fate)];
    }
    result_.counts.stored = result_.crossings.size();
    return std::move(result_);
  }

 private:
  struct Arrival {
    double distance_mm;
    Vector2 plane_mm;
    bool from_front;
  };

  struct Photon {
    Photon(std::uint64_t number_, const Ray& ray_, std::uint64_t key)
        : number(number_), ray(ray_), chance(key, Purpose::interaction, number_) {}
    std::uint64_t number;
    Ray ray;
    RandomStream chance;
    bool touched = false;   ///< has met the mirror
    bool received = false;  ///< has crossed the invisible near field's own area from the front
    bool on_field = false;  ///< starts from the near field, whose plane it cannot meet again before turning
    int interactions = 0;
  };

  Fate follow(std::uint64_t number, const Ray& ray) {
    Photon photon(number, ray, flight_.key);
    for (;;) {
      const auto hit = next_hit(photon);
      const auto arrival = meet_plane(photon, hit ? hit->distance_mm : HUGE_VAL);
      const bool stops = arrival && field_.material() && field_.contains(arrival->plane_mm);
      if (arrival && photon.touched) record(photon, *arrival);
      if (!stops && !hit)
        return !photon.touched ? Fate::missed : photon.received ? Fate::received : Fate::escaped;
      if (photon.interactions == flight_.options.most_interactions) return Fate::cut_off;
      ++photon.interactions;
      ++result_.counts.interactions;
      if (stops) {
        if (!leave_field(photon, *arrival)) return photon.touched ? Fate::received : Fate::missed;
      } else if (!leave_mirror(photon, *hit)) {
        return Fate::absorbed;
      }
    }
  }

  std::optional<Hit> next_hit(const Photon& photon) {
    const bool starts_on_mirror = photon.touched && !photon.on_field;
    if (starts_on_mirror && flight_.opening && flight_.opening->lets_out(photon.ray)) return std::nullopt;
    return probe_->first_hit(photon.ray, flight_.lift_mm);
  }

  /// Where the photon's flight meets the near field's plane before `reach_mm`. The plane belongs to the
  /// stretch that ends on it and not to the one that starts on it, so that no meeting counts twice.
  std::optional<Arrival> meet_plane(const Photon& photon, double reach_mm) const {
    if (photon.on_field) return std::nullopt;
    const double height_mm = (photon.ray.origin_mm - field_.center_mm()).dot(field_.normal());
    const double climb = photon.ray.direction.dot(field_.normal());
    if (!(height_mm * climb < 0)) return std::nullopt;
    const double distance_mm = -height_mm / climb;
    if (!(distance_mm <= reach_mm)) return std::nullopt;
    return Arrival{distance_mm, field_.to_plane(photon.ray.origin_mm + distance_mm * photon.ray.direction),
                   climb < 0};
  }

  void record(Photon& photon, const Arrival& arrival) {
    if (!flight_.area.contains(arrival.plane_mm)) return;
    const std::uint64_t photon_and_side = 2 * photon.number + (arrival.from_front ? 1 : 0);
    result_.crossings.push_back({arrival.plane_mm.x(), arrival.plane_mm.y(), photon_and_side});
    if (arrival.from_front && field_.contains(arrival.plane_mm)) photon.received = true;
  }

  /// @out false when the photon is absorbed
  bool leave_mirror(Photon& photon, const Hit& hit) {
    if (!photon.touched) ++result_.counts.met_mirror;
    photon.touched = true;
    photon.on_field = false;
    photon.ray.origin_mm = hit.point_mm;
    const Interaction interaction = decide(flight_.scene.mirror, photon.chance);
    if (interaction == Interaction::reflected)
      photon.ray.direction = reflect(photon.ray.direction, hit.normal);
    return interaction != Interaction::absorbed;
  }

  bool leave_field(Photon& photon, const Arrival& arrival) {
    photon.on_field = true;
    photon.ray.origin_mm = field_.to_space(arrival.plane_mm);
    const Interaction interaction = decide(*field_.material(), photon.chance);
    if (interaction == Interaction::reflected) {
      const double first = photon.chance.uniform();
      const double second = photon.chance.uniform();
      const Vector3 normal = arrival.from_front ? field_.normal() : Vector3(-field_.normal());
      photon.ray.direction =
          diffuse_direction(field_.first_axis(), field_.second_axis(), normal, first, second);
    }
    return interaction != Interaction::absorbed;
  }

  /// A perfect surface needs no random number.
  static Interaction decide(const Material& material, RandomStream& chance) {
    if (material.reflectance >= 1) return Interaction::reflected;
    return roulette(material, chance.uniform());
  }

  const Flight& flight_;
  const NearField& field_;
  std::unique_ptr<Probe> probe_;
  ChunkResult result_;
};

}  // namespace

void check(const PhotonOptions& options) {
  if (options.photons > most_photons)
    throw InputError({fmt::format("{} photons", options.photons), "",
                      fmt::format("one set holds at most {}", most_photons),
                      "average several sets of another stream"});
  if (options.most_interactions < 1)
    throw InputError({fmt::format("most_interactions is {}", options.most_interactions), "",
                      "a photon must be allowed to meet the mirror once", "1000 is usual"});
}

ProjectionMap emission_map(const Scene& scene) {
  if (auto defect = find_defect(scene.mirror)) {
    defect->where = "mirror";
    throw InputError(std::move(*defect));
  }
  const auto& material = scene.near_field.material();
  if (material && material->reflectance > 0) return ProjectionMap::whole_sphere();
  return ProjectionMap::towards(scene.reflector.profile(), scene.source.position_mm());
}

struct PhotonFlights::Parts {
  Scene scene;
  RecordedArea area;
  ProjectionMap map;
  std::optional<Opening> opening;
  double lift_mm;
};

PhotonFlights::PhotonFlights(const Scene& scene, const RecordedArea& area)
    : parts_(new Parts{scene, area, emission_map(scene), Opening::of(scene.reflector.profile()),
                       Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm}) {}
PhotonFlights::~PhotonFlights() = default;

std::uint64_t PhotonFlights::chunks(std::uint64_t photons) {
  return photons / photons_of_a_chunk + (photons % photons_of_a_chunk != 0);
}

FlightTotals PhotonFlights::fly(const PhotonOptions& options, const TakeCrossings& take) const {
  check(options);
  const Flight flight{parts_->scene,  options,         parts_->map,
                      parts_->area,   parts_->opening, photon_key(options.seed, options.stream),
                      parts_->lift_mm};
  const std::uint64_t photons = options.photons;
  SharedCounts counts;
  tbb::parallel_for(std::uint64_t{0}, chunks(photons), [&](std::uint64_t i) {
    const std::uint64_t first = i * photons_of_a_chunk;
    ChunkResult chunk = PhotonTracer(flight).trace(first, std::min(first + photons_of_a_chunk, photons));
    counts.add(chunk.counts);
    take(i, std::move(chunk.crossings));
  });

  return counts.totals(photons, parts_->scene.source.power_into_w(parts_->map));
}

TracedPhotons trace_photons(const Scene& scene, const PhotonOptions& options, double margin_mm) {
  TracedPhotons traced;
  traced.area = RecordedArea::about(scene.near_field, margin_mm);
  check(options);
  std::vector<std::vector<Crossing>> chunks(PhotonFlights::chunks(options.photons));
  const FlightTotals totals =
      PhotonFlights(scene, traced.area).fly(options, [&](std::uint64_t i, std::vector<Crossing>&& crossings) {
        chunks[i] = std::move(crossings);
      });
  traced.photon_power_w = totals.photon_power_w;
  traced.energy = totals.energy;
  traced.counts = totals.counts;
  traced.crossings.reserve(traced.counts.stored);
  for (const auto& chunk : chunks)
    traced.crossings.insert(traced.crossings.end(), chunk.begin(), chunk.end());
  return traced;
}

}  // namespace catoptric::sim
