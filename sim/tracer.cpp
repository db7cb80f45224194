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
#include "sim/fresnel.h"
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
  bool departs = false;                ///< there is no near field; where photons go is what is asked for
  const Surroundings* room = nullptr;  ///< null: mirror and near field are all there is
  const std::vector<RecordedArea>* more = nullptr;  ///< of the room's fields
};

/// Traces one chunk of photons with a probe of its own, wave after wave: all photons on their way are
/// intersected together, since engines that work on several rays at a time are faster for it.
class PhotonTracer {
 public:
  explicit PhotonTracer(Flight flight)
      : flight_(flight),
        field_(flight.scene.near_field),
        direct_too_(is_direct_sampled(flight.scene) || flight.departs),
        all_alike_(direct_too_ || (flight.room && flight.room->sends_light_on())),
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
  /// Where a photon's flight ends.
  struct Stop {
    double distance_mm;
    std::optional<std::size_t> field;  ///< a real one
    Arrival arrival;                   ///< there
    Surroundings::Stop object;         ///< else
  };

  struct Photon {
    Photon(std::uint64_t number_, const Ray& ray_, std::uint64_t key)
        : number(number_), ray(ray_), chance(key, Purpose::interaction, number_) {}
    std::uint64_t number;
    Ray ray;
    RandomStream chance;
    bool touched = false;                      ///< has met the mirror
    bool scattered = false;                    ///< has gone on from something else in the room
    bool received = false;                     ///< has crossed an invisible field's own area from the front
    bool on_mirror = false;                    ///< starts from the mirror
    std::optional<std::size_t> on_field = {};  ///< starts from this field, which it does not meet again there
    std::optional<Surroundings::Face> on_face = {};  ///< or from this face
    std::optional<std::size_t> inside = {};          ///< flies through this body of glass
    bool along = false;                              ///< there: its field swings in the plane of incidence
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
      asked_.push_back(!photon.inside &&
                       !(photon.on_mirror && flight_.opening && flight_.opening->lets_out(photon.ray)));
      if (asked_.back()) rays_.push_back(photon.ray);
    }
    hits_.resize(rays_.size());
    probe_->first_hits(rays_, flight_.lift_mm, hits_);
  }

  /// Takes a photon to its next surface.
  /// @out its fate, or nothing when it goes on
  std::optional<Fate> advance(Photon& photon, const std::optional<Hit>& hit) {
    const double mirror_mm = hit ? hit->distance_mm : HUGE_VAL;
    const auto stop = flight_.room ? stop_in_room(photon, mirror_mm) : stop_on_field(photon, mirror_mm);
    const double reach_mm = stop ? stop->distance_mm : mirror_mm;
    if (photon.inside) {
      if (const auto fate = cross_glass(photon, stop)) return fate;
    } else if (photon.touched || photon.scattered || direct_too_) {
      record_flight(photon, reach_mm, stop);
    }
    if (!stop && !hit) {
      if (flight_.departs) result_.departures.push_back(photon.ray);
      return !is_met(photon) ? Fate::missed : photon.received ? Fate::received : Fate::escaped;
    }
    if (photon.interactions == flight_.options.most_interactions) return Fate::cut_off;
    ++photon.interactions;
    ++result_.counts.interactions;
    if (!stop) return leave_mirror(photon, *hit) ? std::optional<Fate>{} : Fate::absorbed;
    if (stop->field) {
      if (!leave_field(photon, stop->arrival, *stop->field))
        return is_met(photon) ? Fate::received : Fate::missed;
    } else if (!leave_object(photon, stop->object)) {
      return photon.touched ? Fate::stopped : Fate::stopped_untouched;
    }
    return std::nullopt;
  }

  /// Whether a photon's light counts as the luminaire's and the room's, not as straight from the source.
  static bool is_met(const Photon& photon) { return photon.touched || photon.scattered; }

  const NearField& field_at(std::size_t field) const {
    return field == 0 ? field_ : flight_.room->fields()[field - 1].field;
  }
  std::size_t fields() const {
    return flight_.departs ? 0 : 1 + (flight_.room ? flight_.room->fields().size() : 0);
  }

  Arrivals meet(const Photon& photon, std::size_t field, double reach_mm) const {
    return field_at(field).meet(photon.ray, photon.on_field == field, reach_mm);
  }

  /// Where a real near field ends the flight, if it does before `reach_mm`.
  std::optional<Stop> stop_on_field(const Photon& photon, double reach_mm) const {
    if (flight_.departs || !field_.material()) return std::nullopt;
    for (const Arrival& arrival : meet(photon, 0, reach_mm))
      if (field_.contains(arrival.plane_mm)) return Stop{arrival.distance_mm, 0, arrival, {}};
    return std::nullopt;
  }

  /// The same of all that stands in the room.
  std::optional<Stop> stop_in_room(const Photon& photon, double reach_mm) const {
    std::optional<Stop> nearest;
    for (std::size_t i = 0; i < fields() && !photon.inside; ++i) {
      if (!field_at(i).material()) continue;
      for (const Arrival& arrival : meet(photon, i, reach_mm)) {
        if (!field_at(i).contains(arrival.plane_mm)) continue;
        reach_mm = arrival.distance_mm;
        nearest = Stop{reach_mm, i, arrival, {}};
        break;
      }
    }
    if (const auto object = flight_.room->first(photon.ray, photon.on_face, photon.inside, reach_mm))
      nearest = Stop{object->meeting.distance_mm, {}, {}, *object};
    return nearest;
  }

  /// Records what the flight crosses: all invisible fields before its end, and the real one that it ends on.
  void record_flight(Photon& photon, double reach_mm, const std::optional<Stop>& stop) {
    for (std::size_t i = 0; i < fields(); ++i) {
      if (field_at(i).material()) continue;
      for (const Arrival& arrival : meet(photon, i, reach_mm)) record(photon, arrival, i);
    }
    if (stop && stop->field) record(photon, stop->arrival, *stop->field);
  }

  void record(Photon& photon, const Arrival& arrival, std::size_t field) {
    if (field > 0 && flight_.more->empty()) return;
    const RecordedArea& area = field == 0 ? flight_.area : (*flight_.more)[field - 1];
    const NearField& patch = field_at(field);
    const std::uint64_t photon_and_side =
        2 * photon.number + (arrival.from_front ? 1 : 0) + (std::uint64_t{field} << Crossing::field_bits_at);
    const auto add = [&](const Vector2& plane_mm) {
      if (area.contains(plane_mm)) result_.crossings.push_back({plane_mm.x(), plane_mm.y(), photon_and_side});
    };
    add(arrival.plane_mm);
    if (patch.shape() == NearField::Shape::cylinder)  // once more beyond the seam
      add(arrival.plane_mm - Vector2(std::copysign(2 * patch.half_width_mm(), arrival.plane_mm.x()), 0));
    if (is_met(photon) && arrival.from_front && patch.contains(arrival.plane_mm)) photon.received = true;
  }

  /// @out false when the photon is absorbed
  bool leave_mirror(Photon& photon, const Hit& hit) {
    const bool first = !photon.touched;
    if (first) ++result_.counts.met_mirror;
    photon.touched = true;
    start_on(photon, hit.point_mm);
    photon.on_mirror = true;
    const Roulette roulette = first && !all_alike_ ? Roulette::survivors : Roulette::all;
    return go_on(photon,
                 scatter(flight_.scene.mirror, roulette, photon.ray.direction, hit.normal, photon.chance));
  }

  bool leave_field(Photon& photon, const Arrival& arrival, std::size_t number) {
    const NearField& field = field_at(number);
    start_on(photon, field.to_space(arrival.plane_mm));
    photon.on_field = number;
    Eigen::Matrix3d frame;
    if (field.shape() == NearField::Shape::cylinder) {
      const Vector3 front = field.front_at(arrival.plane_mm);
      frame << field.normal(), front.cross(field.normal()), front;
    } else {
      frame << field.first_axis(), field.second_axis(), field.normal();
    }
    const bool goes_on =
        go_on(photon, scatter(*field.material(), Roulette::all, photon.ray.direction, frame, photon.chance));
    if (flight_.room && goes_on) photon.scattered = true;
    return goes_on;
  }

  bool leave_object(Photon& photon, const Surroundings::Stop& stop) {
    const Object& object = flight_.room->objects()[stop.face.object];
    start_on(photon, photon.ray.origin_mm + stop.meeting.distance_mm * photon.ray.direction);
    photon.on_face = stop.face;
    if (object.glass) return leave_glass(photon, *object.glass, stop);
    const bool goes_on = go_on(photon, scatter(object.material, Roulette::all, photon.ray.direction,
                                               stop.meeting.normal, photon.chance));
    if (goes_on) photon.scattered = true;
    return goes_on;
  }

  /// @out whether it does
  static bool go_on(Photon& photon, const Scattered& after) {
    photon.ray.direction = after.direction;
    return after.interaction != Interaction::absorbed;
  }

  /// A photon from a polished face: thrown back by Fresnel's share, else refracted. It comes unpolarised and
  /// keeps, inside, the polarisation that it entered with: between parallel or concentric faces all planes of
  /// incidence are one.
  /// @out false where it meets a face from behind from outside: it has come through the body's black edge
  static bool leave_glass(Photon& photon, const Glass& glass, const Surroundings::Stop& stop) {
    const double towards_front = photon.ray.direction.dot(stop.meeting.normal);
    const bool from_inside = towards_front > 0;
    if (from_inside != photon.inside.has_value()) return false;
    photon.scattered = true;
    const double ratio = from_inside ? 1 / glass.index : glass.index;
    const auto onwards = refract(photon.ray.direction, stop.meeting.normal, ratio);
    const PolarisedReflectance share = polarised_reflectance(std::min(1.0, std::abs(towards_front)), ratio);
    const double thrown_back = !from_inside ? share.mean() : photon.along ? share.along : share.across;
    if (!onwards || photon.chance.uniform() < thrown_back) {
      photon.ray.direction = reflect(photon.ray.direction, stop.meeting.normal);
      return true;
    }
    photon.ray.direction = *onwards;
    if (from_inside) {
      photon.inside.reset();
    } else {
      photon.inside = stop.face.object;
      photon.along = photon.chance.uniform() * (2 - share.across - share.along) < 1 - share.along;
    }
    return true;
  }

  /// A flight through glass: some of it is absorbed on its way, and all that meets no face, at the edge.
  std::optional<Fate> cross_glass(Photon& photon, const std::optional<Stop>& stop) const {
    const Fate lost = photon.touched ? Fate::stopped : Fate::stopped_untouched;
    if (!stop) return lost;
    const double absorption = flight_.room->objects()[*photon.inside].glass->absorption_per_mm;
    if (absorption > 0 && photon.chance.uniform() >= std::exp(-absorption * stop->distance_mm)) return lost;
    return std::nullopt;
  }

  static void start_on(Photon& photon, const Vector3& point_mm) {
    photon.ray.origin_mm = point_mm;
    photon.on_mirror = false;
    photon.on_field.reset();
    photon.on_face.reset();
  }

  Flight flight_;
  const NearField& field_;
  bool direct_too_;  ///< photons that have not met the mirror are recorded as well
  bool all_alike_;   ///< and so carry the same as those that have
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
  const bool past_mirror =
      is_direct_sampled(scene) || (scene.surroundings && scene.surroundings->sends_light_on());
  return past_mirror ? 1 : surviving_share(scene.mirror);
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
    return PhotonTracer({scene, options, *emission, area, opening, key, lift_mm, false, room, &more})
        .trace(first, last);
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
    PhotonTracer tracer({scene, options, *emission, nowhere, opening, key, lift_mm, true, room, &none});
    const ChunkResult chunk = tracer.trace(first, std::min(first + photons_of_a_chunk, options.photons));
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
