#include "sim/tracer.h"

#include <fmt/format.h>

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
#include "sim/plane_tracer.h"
#include "sim/projection_map.h"
#include "sim/scatter.h"
#include "sim/side_by_side.h"
#include "sim/turns.h"

namespace catoptric::sim {
namespace {

struct ChunkResult {
  std::vector<Crossing> crossings;
  std::vector<Ray> departures;  ///< of photons that left, where these are asked for
  FlightCounts counts;
};

/// What every task of a set shares.
struct Flight {
  const Scene& scene;
  const PhotonOptions& options;
  const Emission& emission;
  const RecordedArea& area;
  const std::optional<Opening>& opening;
  std::uint64_t key;
  double lift_mm;
  bool departs = false;  ///< there is no near field; where photons go is what is asked for
};

/// Traces one chunk of photons with a probe of its own, wave after wave: all photons on their way are
/// intersected together, since engines that work on several rays at a time are faster for it.
class PhotonTracer {
 public:
  explicit PhotonTracer(Flight flight)
      : flight_(flight),
        field_(flight.scene.near_field),
        direct_too_(flight.scene.source.is_sampled() || flight.departs),
        probe_(flight.scene.reflector.probe()) {}

  ChunkResult trace(std::uint64_t first, std::uint64_t last) {
    result_ = {};
    for (std::uint64_t next = first; next < last; next += photons_of_a_wave)
      trace_wave(next, std::min(next + photons_of_a_wave, last));
    // Photons that went on have been passed by later ones; each photon's own crossings keep their order.
    const auto earlier = [](const Crossing& a, const Crossing& b) { return a.photon() < b.photon(); };
    if (!std::is_sorted(result_.crossings.begin(), result_.crossings.end(), earlier))
      std::stable_sort(result_.crossings.begin(), result_.crossings.end(), earlier);
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

  /// Enough for engines that take several rays at a time, few enough to stay in the nearer caches.
  static constexpr std::uint64_t photons_of_a_wave = 128;

  void trace_wave(std::uint64_t first, std::uint64_t last) {
    emit(first, last);
    while (!photons_.empty()) {
      find_hits();
      std::size_t going_on = 0, answer = 0;
      for (std::size_t i = 0; i < photons_.size(); ++i) {
        const auto fate = advance(photons_[i], asked_[i] ? hits_[answer++] : no_hit_);
        if (fate)
          ++result_.counts.ended[static_cast<std::size_t>(*fate)];
        else if (going_on++ != i)
          photons_[going_on - 1] = photons_[i];
      }
      photons_.erase(photons_.begin() + static_cast<std::ptrdiff_t>(going_on), photons_.end());
    }
  }

  void emit(std::uint64_t first, std::uint64_t last) {
    const std::size_t rows = flight_.emission.numbers();
    std::array<std::vector<double>, most_emission_numbers> numbers;
    std::array<std::span<double>, most_emission_numbers> spans;
    for (std::size_t row = 0; row < rows; ++row) {
      numbers[row].resize(last - first);
      spans[row] = numbers[row];
    }
    EmissionNumbers(flight_.options.sampler, flight_.key).draw(first, std::span(spans).first(rows));
    photons_.reserve(last - first);
    for (std::uint64_t photon = first; photon < last; ++photon) {
      std::array<double, most_emission_numbers> own{};
      for (std::size_t row = 0; row < rows; ++row) own[row] = numbers[row][photon - first];
      photons_.emplace_back(photon, flight_.emission.emit(own, flight_.options.stream), flight_.key);
    }
  }

  /// Fills hits_, one for each photon whose ray is asked; none is where a photon certainly leaves.
  void find_hits() {
    rays_.clear();
    asked_.clear();
    for (const Photon& photon : photons_) {
      const bool starts_on_mirror = photon.touched && !photon.on_field;
      asked_.push_back(!(starts_on_mirror && flight_.opening && flight_.opening->lets_out(photon.ray)));
      if (asked_.back()) rays_.push_back(photon.ray);
    }
    hits_.resize(rays_.size());
    probe_->first_hits(rays_, flight_.lift_mm, hits_);
  }

  /// Takes a photon to its next surface.
  /// @out its fate, or nothing when it goes on
  std::optional<Fate> advance(Photon& photon, const std::optional<Hit>& hit) {
    const auto arrival =
        flight_.departs ? std::nullopt : meet_plane(photon, hit ? hit->distance_mm : HUGE_VAL);
    const bool stops = arrival && field_.material() && field_.contains(arrival->plane_mm);
    if (arrival && (photon.touched || direct_too_)) record(photon, *arrival);
    if (!stops && !hit) {
      if (flight_.departs) result_.departures.push_back(photon.ray);
      return !photon.touched ? Fate::missed : photon.received ? Fate::received : Fate::escaped;
    }
    if (photon.interactions == flight_.options.most_interactions) return Fate::cut_off;
    ++photon.interactions;
    ++result_.counts.interactions;
    if (stops) {
      if (!leave_field(photon, *arrival)) return photon.touched ? Fate::received : Fate::missed;
    } else if (!leave_mirror(photon, *hit)) {
      return Fate::absorbed;
    }
    return std::nullopt;
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
    if (photon.touched && arrival.from_front && field_.contains(arrival.plane_mm)) photon.received = true;
  }

  /// @out false when the photon is absorbed
  bool leave_mirror(Photon& photon, const Hit& hit) {
    const bool first = !photon.touched;
    if (first) ++result_.counts.met_mirror;
    photon.touched = true;
    photon.on_field = false;
    photon.ray.origin_mm = hit.point_mm;
    const Material& mirror = flight_.scene.mirror;
    const Interaction interaction = first && !direct_too_
                                        ? first_interaction(mirror, [&] { return photon.chance.uniform(); })
                                        : decide(mirror, photon.chance);
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

  Flight flight_;
  const NearField& field_;
  bool direct_too_;  ///< photons that have not met the mirror are recorded as well
  std::unique_ptr<Probe> probe_;
  std::vector<Photon> photons_;           ///< on their way
  std::vector<char> asked_;               ///< of each: whether its ray is asked of the probe in this wave
  std::vector<Ray> rays_;                 ///< those that are
  std::vector<std::optional<Hit>> hits_;  ///< the probe's answers
  const std::optional<Hit> no_hit_;
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

void give_up_if_stopped(const PhotonOptions& options) {
  if (options.stop && options.stop->load(std::memory_order_relaxed)) throw Interrupted();
}

std::unique_ptr<const Emission> emission_of(const Scene& scene) {
  if (auto defect = find_defect(scene.mirror)) {
    defect->where = "mirror";
    throw InputError(std::move(*defect));
  }
  const auto& material = scene.near_field.material();
  if (scene.source.is_sampled() || (material && material->reflectance > 0)) return scene.source.emission();
  return scene.source.emission_to(scene.reflector.profile());
}

double first_share(const Scene& scene) {
  return scene.source.is_sampled() ? 1 : surviving_share(scene.mirror);
}

struct PhotonFlights::Parts {
  Scene scene;
  RecordedArea area;
  std::unique_ptr<const Emission> emission;
  std::optional<Opening> opening;
  double lift_mm;
  std::optional<PlaneScene> plane;  ///< where no photon leaves its meridian plane

  ChunkResult trace(const PhotonOptions& options, std::uint64_t key, std::uint64_t first,
                    std::uint64_t last) const {
    if (plane) return trace_in_plane(options, key, first, static_cast<std::size_t>(last - first));
    return PhotonTracer({scene, options, *emission, area, opening, key, lift_mm}).trace(first, last);
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
                       emission_of(scene),
                       Opening::of(scene.reflector.profile()),
                       Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm,
                       {}}) {
  if (space == FlightSpace::as_needed && PlaneScene::possible(scene)) parts_->plane.emplace(scene, area);
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
  return fly(options, take, std::max<std::uint64_t>(1, chunks(options.photons)), [] {});
}

double PhotonFlights::photon_power_w(std::uint64_t photons) const {
  return SharedCounts()
      .totals(photons, parts_->emission->power_w(), first_share(parts_->scene))
      .photon_power_w;
}

FlightTotals PhotonFlights::fly(const PhotonOptions& options, const TakeCrossings& take,
                                std::uint64_t chunks_of_a_batch, const std::function<void()>& landed) const {
  check(options);
  CATOPTRIC_EXPECTS(chunks_of_a_batch > 0);
  const std::uint64_t key = photon_key(options.seed, options.stream);
  const std::uint64_t photons = options.photons;
  SharedCounts counts;
  const auto fly_chunk = [&](std::uint64_t i) {
    give_up_if_stopped(options);
    const std::uint64_t first = i * photons_of_a_chunk;
    ChunkResult chunk = parts_->trace(options, key, first, std::min(first + photons_of_a_chunk, photons));
    counts.add(chunk.counts);
    take(i, std::move(chunk.crossings));
  };
  std::uint64_t begin = 0;
  do {
    const std::uint64_t end = std::min(chunks(photons), begin + chunks_of_a_batch);
    side_by_side(end - begin, [&](std::uint64_t i) { fly_chunk(begin + i); });
    landed();
    begin = end;
  } while (begin < chunks(photons));

  return counts.totals(photons, parts_->emission->power_w(), first_share(parts_->scene));
}

FlightTotals depart(const Scene& scene, const PhotonOptions& options, const TakeDepartures& take) {
  check(options);
  if (auto defect = find_defect(scene.mirror)) {
    defect->where = "mirror";
    throw InputError(std::move(*defect));
  }
  const auto emission = scene.source.emission();
  const auto opening = Opening::of(scene.reflector.profile());
  const RecordedArea nowhere = RecordedArea::about(scene.near_field, 0);
  const std::uint64_t key = photon_key(options.seed, options.stream);
  const double lift_mm = Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm;
  SharedCounts counts;
  side_by_side(PhotonFlights::chunks(options.photons), [&](std::uint64_t i) {
    give_up_if_stopped(options);
    const std::uint64_t first = i * photons_of_a_chunk;
    PhotonTracer tracer({scene, options, *emission, nowhere, opening, key, lift_mm, true});
    const ChunkResult chunk = tracer.trace(first, std::min(first + photons_of_a_chunk, options.photons));
    counts.add(chunk.counts);
    take(i, chunk.departures);
  });
  return counts.totals(options.photons, emission->power_w(), 1);
}

StoredChunk store(std::span<const Crossing> crossings, const RecordedArea& area) {
  const BandOf band_of(area);
  std::array<std::array<std::size_t, photon_bands>, 2> counts{};
  for (const Crossing& crossing : crossings) ++counts[crossing.from_front()][band_of(crossing.y_mm)];
  StoredChunk chunk;
  for (std::size_t band = 0; band < photon_bands; ++band) {
    chunk.front[band].reserve(counts[1][band]);
    chunk.back[band].reserve(counts[0][band]);
  }
  for (const Crossing& crossing : crossings)
    (crossing.from_front() ? chunk.front : chunk.back)[band_of(crossing.y_mm)].push_back(
        {crossing.x_mm, crossing.y_mm});
  return chunk;
}

TracedPhotons trace_photons(const PhotonFlights& flights, const PhotonOptions& options) {
  check(options);
  TracedPhotons traced;
  traced.area = flights.area();
  traced.chunks.resize(PhotonFlights::chunks(options.photons));
  const FlightTotals totals = flights.fly(options, [&](std::uint64_t i, std::vector<Crossing>&& crossings) {
    traced.chunks[i] = store(crossings, traced.area);
  });
  traced.photon_power_w = totals.photon_power_w;
  traced.energy = totals.energy;
  traced.counts = totals.counts;
  return traced;
}

TracedPhotons trace_photons(const Scene& scene, const PhotonOptions& options, double margin_mm) {
  check(options);
  return trace_photons(PhotonFlights(scene, RecordedArea::about(scene.near_field, margin_mm)), options);
}

}  // namespace catoptric::sim
