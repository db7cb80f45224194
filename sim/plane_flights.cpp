#include "sim/plane_flights.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/planar_hits.h"
#include "base/random_stream.h"
#include "base/tolerance.h"
#include "sim/flight_counts.h"
#include "sim/opening.h"

namespace catoptric::sim {

struct PlaneFlights::Parts {
  Scene scene;
  ProjectionMap map;
  std::optional<Opening> opening;
  PlanarMirror mirror;
  double lift_mm;
  double plane_z_mm, up;              ///< of the field; +1 when its normal looks along z
  double field_square, reach_square;  ///< of the radii: the field's own edge, the recorded area's
};

namespace {

/// The one number of the emission that matters in a plane. For the sampler "sobol" photon i of n gets a
/// random place in the i-th of n even intervals, which is what scrambling makes of the first coordinate of
/// 2^k Sobol points, and holds for any n.
class FirstNumbers {
 public:
  FirstNumbers(const PhotonOptions& options, std::uint64_t key, std::uint64_t first)
      : place_(static_cast<double>(first)),
        step_(1 / static_cast<double>(options.photons)),
        shifts_(key, Purpose::scrambling, first + 1) {  // index 0 scrambles points of more dimensions
    if (options.sampler == Sampler::random)
      random_ = EmissionNumbers::starting_at(options.sampler, key, first);
  }

  double next() {
    if (random_) return random_->next()[0];
    const double number = (place_ + shifts_.uniform()) * step_;
    place_ += 1;
    return std::min(number, below_one);
  }

 private:
  static constexpr double below_one = 1 - 0x1p-53;  // the last interval's end may round up
  double place_, step_;
  RandomStream shifts_;
  std::unique_ptr<EmissionNumbers> random_;
};

/// Traces chunks of photons of one set.
template <typename Parts>
class PlaneTracer {
 public:
  PlaneTracer(const Parts& parts, const PhotonOptions& options, std::uint64_t key, bool front)
      : parts_(parts), options_(options), key_(key), front_(front) {}

  void trace(std::uint64_t first, std::uint64_t last) {
    squares_.reserve(last - first);
    FirstNumbers numbers(options_, key_, first);
    for (std::uint64_t photon = first; photon < last; ++photon) {
      const Ray ray = parts_.scene.source.emit(parts_.map, {numbers.next(), 0, 0, 0});
      const Fate fate = follow({photon, {0, ray.origin_mm.z(), ray.direction.x(), ray.direction.z()}});
      ++counts_.ended[static_cast<std::size_t>(fate)];
    }
  }

  const std::vector<double>& squares() const { return squares_; }
  const FlightCounts& counts() const { return counts_; }

 private:
  struct Photon {
    std::uint64_t number;
    PlanarRay ray;
    std::optional<RandomStream> chance = {};
    bool touched = false, received = false, on_field = false;
    int interactions = 0;
  };
  struct Arrival {
    double distance_mm, x_mm;
    bool from_front;
  };

  Fate follow(Photon photon) {
    const auto& material = parts_.scene.near_field.material();
    for (;;) {
      const auto hit = next_hit(photon);
      const auto arrival = meet_plane(photon, hit ? hit->distance_mm : HUGE_VAL);
      const double square = arrival ? arrival->x_mm * arrival->x_mm : 0;
      const bool stops = arrival && material && square <= parts_.field_square;
      if (arrival && photon.touched) record(photon, *arrival, square);
      if (!stops && !hit)
        return !photon.touched ? Fate::missed : photon.received ? Fate::received : Fate::escaped;
      if (photon.interactions == options_.most_interactions) return Fate::cut_off;
      ++photon.interactions;
      ++counts_.interactions;
      if (stops) {
        photon.on_field = true;
        photon.ray.x_mm = arrival->x_mm;
        photon.ray.z_mm = parts_.plane_z_mm;
        if (decide(*material, photon) == Interaction::absorbed)
          return photon.touched ? Fate::received : Fate::missed;
      } else if (!leave_mirror(photon, *hit)) {
        return Fate::absorbed;
      }
    }
  }

  std::optional<PlanarHit> next_hit(const Photon& photon) const {
    const PlanarRay& ray = photon.ray;
    if (photon.touched && !photon.on_field && parts_.opening &&
        parts_.opening->lets_out({{ray.x_mm, 0, ray.z_mm}, {ray.dx, 0, ray.dz}}))
      return std::nullopt;
    return parts_.mirror.first_hit(ray, parts_.lift_mm);
  }

  std::optional<Arrival> meet_plane(const Photon& photon, double reach_mm) const {
    if (photon.on_field) return std::nullopt;
    const double height_mm = photon.ray.z_mm - parts_.plane_z_mm;
    if (!(height_mm * photon.ray.dz < 0)) return std::nullopt;
    const double distance_mm = -height_mm / photon.ray.dz;
    if (!(distance_mm <= reach_mm)) return std::nullopt;
    return Arrival{distance_mm, photon.ray.x_mm + distance_mm * photon.ray.dx, photon.ray.dz * parts_.up < 0};
  }

  void record(Photon& photon, const Arrival& arrival, double square) {
    if (!(square <= parts_.reach_square)) return;
    ++counts_.stored;
    if (arrival.from_front == front_) squares_.push_back(square);
    if (arrival.from_front && square <= parts_.field_square) photon.received = true;
  }

  /// @out false when the photon is absorbed
  bool leave_mirror(Photon& photon, const PlanarHit& hit) {
    if (!photon.touched) ++counts_.met_mirror;
    photon.touched = true;
    photon.on_field = false;
    photon.ray.x_mm = hit.x_mm;
    photon.ray.z_mm = hit.z_mm;
    const Interaction interaction = decide(parts_.scene.mirror, photon);
    if (interaction == Interaction::reflected) {
      // What is along the tangent stays, the rest turns round; unit length again, as in space.
      const double along = 2 * (photon.ray.dx * hit.tx + photon.ray.dz * hit.tz);
      const double dx = along * hit.tx - photon.ray.dx, dz = along * hit.tz - photon.ray.dz;
      const double length = std::sqrt(dx * dx + dz * dz);
      photon.ray.dx = dx / length;
      photon.ray.dz = dz / length;
    }
    return interaction != Interaction::absorbed;
  }

  Interaction decide(const Material& material, Photon& photon) const {
    if (material.reflectance >= 1) return Interaction::reflected;
    if (!photon.chance) photon.chance.emplace(key_, Purpose::interaction, photon.number);
    return roulette(material, photon.chance->uniform());
  }

  const Parts& parts_;
  const PhotonOptions& options_;
  std::uint64_t key_;
  bool front_;
  std::vector<double> squares_;
  FlightCounts counts_;
};

}  // namespace

bool PlaneFlights::possible(const Scene& scene) {
  const Vector3 source = scene.source.position_mm();
  const NearField& field = scene.near_field;
  return dynamic_cast<const PointSource*>(&scene.source) && source.x() == 0 && source.y() == 0 &&
         field.shape() == NearField::Shape::disc && field.center_mm().x() == 0 &&
         field.center_mm().y() == 0 && field.normal().x() == 0 && field.normal().y() == 0 &&
         !(field.material() && field.material()->reflectance > 0) && scene.reflector.engine() == "meridian";
}

PlaneFlights::PlaneFlights(const Scene& scene, double reach_mm) {
  const NearField& field = scene.near_field;
  const double edge_mm = field.half_width_mm(), out_mm = field.material() ? edge_mm : reach_mm;
  const Profile& profile = scene.reflector.profile();
  parts_.reset(new Parts{scene, emission_map(scene), Opening::of(profile), PlanarMirror(profile),
                         Tolerance::for_scale(profile.diagonal_mm()).lift_mm, field.center_mm().z(),
                         field.normal().z() > 0 ? 1.0 : -1.0, edge_mm * edge_mm, out_mm * out_mm});
}
PlaneFlights::~PlaneFlights() = default;

FlightTotals PlaneFlights::fly(const PhotonOptions& options, bool front, const TakeSquares& take) const {
  check(options);
  const std::uint64_t key = photon_key(options.seed, options.stream), photons = options.photons;
  SharedCounts counts;
  tbb::parallel_for(std::uint64_t{0}, PhotonFlights::chunks(photons), [&](std::uint64_t i) {
    const std::uint64_t first = i * photons_of_a_chunk;
    PlaneTracer<Parts> tracer(*parts_, options, key, front);
    tracer.trace(first, std::min(first + photons_of_a_chunk, photons));
    counts.add(tracer.counts());
    take(i, tracer.squares());
  });
  return counts.totals(photons, parts_->scene.source.power_into_w(parts_->map));
}

}  // namespace catoptric::sim
