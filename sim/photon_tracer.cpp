#include "sim/photon_tracer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "base/random_stream.h"
#include "sim/glass.h"
#include "sim/scatter.h"

namespace catoptric::sim {
namespace {

/// Traces one chunk of photons with a probe of its own, wave after wave: all photons on their way are
/// intersected together, since engines that work on several rays at a time are faster for it.
class PhotonTracer {
 public:
  explicit PhotonTracer(const Flight& flight)
      : flight_(flight),
        field_(flight.scene.near_field),
        direct_too_(is_direct_sampled(flight.scene) || flight.departs),
        all_alike_(direct_too_ || is_recorded_without_mirror(flight.scene)),
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
      if (flight_.paths) (*flight_.paths)[photon].corners_mm.push_back(photons_.back().ray.origin_mm);
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
      if (flight_.paths) (*flight_.paths)[photon.number].leaves_towards = photon.ray.direction;
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
      if (field_at(i).facets())
        record_facets(photon, reach_mm, i);
      else
        for (const Arrival& arrival : meet(photon, i, reach_mm)) record(photon, arrival, i);
    }
    if (stop && stop->field) record(photon, stop->arrival, *stop->field);
  }

  /// All that the flight meets of facets, one after the other.
  void record_facets(Photon& photon, double reach_mm, std::size_t field) {
    Ray ray = photon.ray;
    bool starts_here = photon.on_field == field;
    while (true) {
      const Arrivals next = field_at(field).meet(ray, starts_here, reach_mm);
      if (next.count == 0) return;
      record(photon, next.at[0], field);
      ray.origin_mm += next.at[0].distance_mm * ray.direction;
      reach_mm -= next.at[0].distance_mm;
      starts_here = true;
    }
  }

  void record(Photon& photon, const Arrival& arrival, std::size_t field) {
    if (field > 0 && flight_.more->empty()) return;
    const RecordedArea& area = field == 0 ? flight_.area : (*flight_.more)[field - 1];
    const NearField& patch = field_at(field);
    if (flight_.paths && field == 0 && patch.contains(arrival.plane_mm))
      (*flight_.paths)[photon.number].landed_mm = patch.to_space(arrival.plane_mm);
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
    if (flight_.paths) (*flight_.paths)[photon.number].met_mirror = true;
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
    } else if (field.facets()) {
      const Vector3 front = field.front_at(arrival.plane_mm), along = front.unitOrthogonal();
      frame << along, front.cross(along), front;
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

  /// @out false where it meets a face from behind from outside: it has come through the body's black edge
  static bool leave_glass(Photon& photon, const Glass& glass, const Surroundings::Stop& stop) {
    const bool from_inside = photon.ray.direction.dot(stop.meeting.normal) > 0;
    if (from_inside != photon.inside.has_value()) return false;
    photon.scattered = true;
    const GlassLight after = cross_face(glass, {photon.ray.direction, from_inside, photon.along},
                                        stop.meeting.normal, photon.chance);
    photon.ray.direction = after.direction;
    photon.inside = after.inside ? std::optional(stop.face.object) : std::nullopt;
    photon.along = after.along;
    return true;
  }

  /// A flight through glass: some of it is absorbed on its way, and all that meets no face, at the edge.
  std::optional<Fate> cross_glass(Photon& photon, const std::optional<Stop>& stop) const {
    const Fate lost = photon.touched ? Fate::stopped : Fate::stopped_untouched;
    if (!stop) return lost;
    const Glass& glass = *flight_.room->objects()[*photon.inside].glass;
    if (glass.absorption_per_mm > 0 &&
        photon.chance.uniform() >= internal_transmittance(glass, stop->distance_mm))
      return lost;
    return std::nullopt;
  }

  void start_on(Photon& photon, const Vector3& point_mm) const {
    if (flight_.paths) (*flight_.paths)[photon.number].corners_mm.push_back(point_mm);
    photon.ray.origin_mm = point_mm;
    photon.on_mirror = false;
    photon.on_field.reset();
    photon.on_face.reset();
  }

  const Flight& flight_;
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

ChunkResult trace_in_space(const Flight& flight, std::uint64_t first, std::uint64_t last) {
  return PhotonTracer(flight).trace(first, last);
}

}  // namespace catoptric::sim
