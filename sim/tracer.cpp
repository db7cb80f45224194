#include "sim/tracer.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/profile.h"
#include "base/random_stream.h"
#include "base/tolerance.h"
#include "sim/projection_map.h"
#include "sim/scatter.h"

namespace catoptric::sim {
namespace {

/// Photons of one task. Fixed, since the joined result must not depend on the number of threads; small, so
/// that even ten thousand photons feed several cores.
constexpr std::uint64_t chunk_size = 1024;

/// How a photon's path ended.
enum class Fate { missed, absorbed, received, escaped, cut_off };

struct ChunkResult {
  std::vector<Crossing> crossings;
  std::array<std::uint64_t, 5> ended{};  ///< photons by Fate
  std::uint64_t met_mirror = 0, interactions = 0;
};

/// What every task shares.
struct Flight {
  const Scene& scene;
  const PhotonOptions& options;
  ProjectionMap map;
  RecordedArea area;
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
      ++result_.ended[static_cast<std::size_t>(fate)];
    }
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
      const auto hit = probe_->first_hit(photon.ray, flight_.lift_mm);
      const auto arrival = meet_plane(photon, hit ? hit->distance_mm : HUGE_VAL);
      const bool stops = arrival && field_.material() && field_.contains(arrival->plane_mm);
      if (arrival && photon.touched) record(photon, *arrival);
      if (!stops && !hit)
        return !photon.touched ? Fate::missed : photon.received ? Fate::received : Fate::escaped;
      if (photon.interactions == flight_.options.most_interactions) return Fate::cut_off;
      ++photon.interactions;
      ++result_.interactions;
      if (stops) {
        if (!leave_field(photon, *arrival)) return photon.touched ? Fate::received : Fate::missed;
      } else if (!leave_mirror(photon, *hit)) {
        return Fate::absorbed;
      }
    }
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
    if (!photon.touched) ++result_.met_mirror;
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

void check(const Scene& scene, const PhotonOptions& options) {
  if (options.photons > most_photons)
    throw InputError({fmt::format("{} photons", options.photons), "",
                      fmt::format("one set holds at most {}", most_photons),
                      "average several sets of another stream"});
  if (options.most_interactions < 1)
    throw InputError({fmt::format("most_interactions is {}", options.most_interactions), "",
                      "a photon must be allowed to meet the mirror once", "1000 is usual"});
  if (auto defect = find_defect(scene.mirror)) {
    defect->where = "mirror";
    throw InputError(std::move(*defect));
  }
}

/// A real near field that reflects may light the mirror from anywhere; else only the mirror's own directions
/// matter (transmission goes straight on, so it needs no others).
ProjectionMap map_for(const Scene& scene) {
  const auto& material = scene.near_field.material();
  if (material && material->reflectance > 0) return ProjectionMap::whole_sphere();
  return ProjectionMap::towards(scene.reflector.profile(), scene.source.position_mm());
}

std::vector<ChunkResult> trace_chunks(const Flight& flight) {
  const std::uint64_t photons = flight.options.photons;
  std::vector<ChunkResult> chunks((photons + chunk_size - 1) / chunk_size);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
    const std::uint64_t first = i * chunk_size;
    chunks[i] = PhotonTracer(flight).trace(first, std::min(first + chunk_size, photons));
  });
  return chunks;
}

}  // namespace

TracedPhotons trace_photons(const Scene& scene, const PhotonOptions& options, double margin_mm) {
  check(scene, options);
  const Flight flight{scene,
                      options,
                      map_for(scene),
                      RecordedArea::about(scene.near_field, margin_mm),
                      photon_key(options.seed, options.stream),
                      Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm};
  TracedPhotons traced;
  traced.area = flight.area;
  traced.energy.emitted_w = options.photons > 0 ? scene.source.power_into_w(flight.map) : 0;
  traced.photon_power_w =
      options.photons > 0 ? traced.energy.emitted_w / static_cast<double>(options.photons) : 0;

  const std::vector<ChunkResult> chunks = trace_chunks(flight);
  std::array<std::uint64_t, 5> ended{};
  for (const ChunkResult& chunk : chunks) {
    traced.counts.met_mirror += chunk.met_mirror;
    traced.counts.interactions += chunk.interactions;
    traced.counts.stored += chunk.crossings.size();
    for (std::size_t i = 0; i < ended.size(); ++i) ended[i] += chunk.ended[i];
  }
  traced.counts.emitted = options.photons;
  traced.crossings.reserve(traced.counts.stored);
  for (const ChunkResult& chunk : chunks)
    traced.crossings.insert(traced.crossings.end(), chunk.crossings.begin(), chunk.crossings.end());

  const auto power_of = [&](Fate fate) {
    return static_cast<double>(ended[static_cast<std::size_t>(fate)]) * traced.photon_power_w;
  };
  traced.energy.missed_w = power_of(Fate::missed);
  traced.energy.absorbed_w = power_of(Fate::absorbed);
  traced.energy.received_w = power_of(Fate::received);
  traced.energy.escaped_w = power_of(Fate::escaped);
  traced.energy.cut_off_w = power_of(Fate::cut_off);
  return traced;
}

}  // namespace catoptric::sim
