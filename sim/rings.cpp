#include "sim/rings.h"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <memory>

#include "base/contract.h"
#include "base/float_traps.h"
#include "base/profile.h"
#include "base/tolerance.h"
#include "base/units.h"
#include "sim/edge_correction.h"
#include "sim/plane_flights.h"
#include "sim/ring_bandwidth.h"
#include "sim/ring_counts.h"
#include "sim/ring_edges.h"
#include "sim/ring_smoothing.h"
#include "sim/ring_store.h"

namespace catoptric::sim {
namespace {

[[noreturn]] void refuse(std::string what, std::string why, std::string hint) {
  throw InputError({std::move(what), "rings", std::move(why), std::move(hint)});
}

void check_radii(double cover_mm, std::span<const double> radii_mm) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  const double most_mm = cover_mm * (1 + Tolerance::for_scale(1).length_mm);
  for (double radius : radii_mm)
    if (!(radius >= 0 && radius <= most_mm))
      refuse(fmt::format("radius of {} mm", radius),
             fmt::format("the near field reaches from the axis to {} mm", cover_mm), "ask inside the field");
}

void check(const Scene& scene, const RingsOptions& options) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (const auto objection = rings_objection(scene))
    refuse("the rung \"rings\" is not valid for this scene", *objection, "use the rung \"photons\"");
  if (options.replicates < 1)
    refuse("0 replicates", "the estimate is the mean of the replicates", "4 tell the noise");
  if (options.photons.photons > most_photons)
    refuse(fmt::format("{} photons", options.photons.photons),
           fmt::format("at most {} are counted", most_photons), "average runs of several streams");
  if (options.bandwidth_mm2 && !(*options.bandwidth_mm2 > 0 && std::isfinite(*options.bandwidth_mm2)))
    refuse(fmt::format("bandwidth of {} mm^2", *options.bandwidth_mm2), "a bandwidth is positive and finite",
           "leave it out to have it chosen");
  if (options.edges_mm)
    for (double radius : *options.edges_mm)
      if (!(radius > 0 && std::isfinite(radius)))
        refuse(fmt::format("edge at a radius of {} mm", radius), "an edge's radius is positive and finite",
               "leave the edges out to have them found");
}

/// The recorded range of r^2, cut at the jumps.
std::vector<double> cuts_for(const Scene& scene, const RingsOptions& options, double end) {
  std::vector<double> squares;
  if (options.edges_mm)
    for (double radius : *options.edges_mm) squares.push_back(radius * radius);
  else if (scene.is_bare())  // things on the way move and stop the beam's edges
    squares = edge_landing_squares(scene);
  std::sort(squares.begin(), squares.end());
  // Nearer than this two cuts are one: the segment between would hold no photon in 1e9.
  const double apart = 1e-9 * end;
  std::vector<double> cuts{0.0};
  for (double s : squares)
    if (s > cuts.back() + apart && s < end - apart) cuts.push_back(s);
  cuts.push_back(end);
  return cuts;
}

std::size_t bins_for(const RingsOptions& options, std::uint64_t photons_per_set) {
  // Few photons too may make a beam a hundredth of the field wide.
  constexpr std::size_t fewest = std::size_t{1} << 14, most = std::size_t{1} << 17;
  if (options.bins) return std::clamp<std::size_t>(*options.bins, 1, most);
  return std::bit_ceil(std::clamp<std::size_t>(photons_per_set, fewest, most));
}

/// The sets of photons in flight and their landing.
class Sets {
 public:
  Sets(const Scene& scene, const RingsOptions& options) : scene_(scene), options_(options) {
    const std::uint64_t photons = options.photons.photons;
    const std::uint64_t sets = std::max<std::uint64_t>(1, std::min(options.replicates, photons));
    for (std::uint64_t i = 0; i < sets; ++i)
      photons_.push_back(photons / sets + (i < photons % sets ? 1 : 0));
  }

  std::unique_ptr<RingStore> store(std::vector<double> cuts) const {
    if (options_.storage == RingStorage::counted)
      return std::make_unique<CountedRings>(std::move(cuts), photons_.size(),
                                            bins_for(options_, photons_[0]));
    std::vector<std::uint64_t> chunks;
    for (std::uint64_t photons : photons_) chunks.push_back(PhotonFlights::chunks(photons));
    return std::make_unique<SortedRings>(std::move(cuts), photons_.size(), chunks);
  }

  /// Lets all sets fly and lists the power of a photon of each.
  std::vector<double> fly(RingStore& store, double reach_mm, RingsField& field) const {
    std::vector<double> powers;
    const auto each_set = [&](const auto& fly_set) {
      for (std::size_t set = 0; set < photons_.size(); ++set) {
        PhotonOptions options = options_.photons;
        options.photons = photons_[set];
        options.seed = photon_key(options_.photons.seed, options_.photons.stream);
        options.stream = set;
        const FlightTotals totals = fly_set(options, set);
        field.energy.add(totals.energy, 1 / static_cast<double>(photons_.size()));
        field.counts.add(totals.counts);
        powers.push_back(totals.photon_power_w);
      }
    };
    if (options_.in_plane && PlaneFlights::possible(scene_))
      fly_in_plane(store, reach_mm, each_set);
    else
      fly_in_space(store, reach_mm, each_set);
    store.close();
    return powers;
  }

 private:
  template <typename EachSet>
  void fly_in_plane(RingStore& store, double reach_mm, const EachSet& each_set) const {
    const PlaneFlights flights(scene_, reach_mm);
    each_set([&](const PhotonOptions& options, std::size_t set) {
      return flights.fly(
          options, options_.front,
          [&](std::uint64_t chunk, const std::vector<double>& squares) { store.add(set, chunk, squares); });
    });
  }

  template <typename EachSet>
  void fly_in_space(RingStore& store, double reach_mm, const EachSet& each_set) const {
    const Vector2 axis = scene_.near_field.to_plane({0, 0, scene_.near_field.center_mm().z()});
    const double out_mm =
        scene_.near_field.material() ? scene_.near_field.half_width_mm() : reach_mm + axis.norm();
    const PhotonFlights flights(scene_, {NearField::Shape::disc, out_mm, out_mm});
    each_set([&](const PhotonOptions& options, std::size_t set) {
      return flights.fly(options, [&](std::uint64_t chunk, std::vector<Crossing>&& crossings) {
        std::vector<double> squares;
        squares.reserve(crossings.size());
        for (const Crossing& crossing : crossings)
          if (crossing.from_front() == options_.front)
            squares.push_back((crossing.plane_mm() - axis).squaredNorm());
        store.add(set, chunk, squares);
      });
    });
  }

  const Scene& scene_;
  const RingsOptions& options_;
  std::vector<std::uint64_t> photons_;
};

void estimate_all(const RingStore& store, std::span<const double> powers, std::span<const double> radii_mm,
                  const RingsOptions& options, RingsField& field) {
  const std::size_t count = radii_mm.size();
  for (auto* part : {&field.irradiance, &field.noise, &field.poisson_noise, &field.bias, &field.debiased,
                     &field.debiased_noise})
    part->resize(count);
  std::vector<double> places(count);
  for (std::size_t i = 0; i < count; ++i) places[i] = std::min(radii_mm[i] * radii_mm[i], store.end());
  const RingEstimator estimator(powers);
  store.estimate(places, options.kernel, field.bandwidth_mm2, [&](std::size_t i, const RingDensity& density) {
    const RingEstimate at = estimator(density);
    field.bias[i] = at.second - at.fourth;
    field.irradiance[i] = at.second;
    field.noise[i] = std::sqrt(at.second_variance);
    field.poisson_noise[i] = std::sqrt(at.second_poisson);
    field.debiased[i] = at.fourth;
    field.debiased_noise[i] = std::sqrt(at.fourth_variance);
  });
}

}  // namespace

double farthest_radius_mm(const NearField& field) {
  const Vector2 axis = field.to_plane({0, 0, field.center_mm().z()});
  if (field.shape() == NearField::Shape::disc) return axis.norm() + field.half_width_mm();
  return std::hypot(std::abs(axis.x()) + field.half_width_mm(), std::abs(axis.y()) + field.half_height_mm());
}

double RingsField::kernel_radius_mm() const { return std::sqrt(2 * bandwidth_mm2); }

double RingsField::half_interval(std::size_t index, double level) const {
  const double tail = 0.5 * (1 - level);
  if (replicates < 2)
    return debiased_noise[index] *
           boost::math::quantile(boost::math::complement(boost::math::normal(), tail));
  const boost::math::students_t student(static_cast<double>(replicates - 1));
  return debiased_noise[index] * boost::math::quantile(boost::math::complement(student, tail));
}

std::optional<std::string> rings_objection(const Scene& scene) {
  if (!scene.is_bare())
    if (auto objection = scene.surroundings->asymmetry()) return objection;
  const Vector3 source = scene.source.position_mm();
  const NearField& field = scene.near_field;
  const Tolerance tolerance = Tolerance::for_scale(scene.reflector.profile().diagonal_mm());
  const double aside_mm = std::hypot(source.x(), source.y());
  if (aside_mm > tolerance.length_mm)
    return fmt::format("the source is {:.4g} mm off the axis, so the light differs from azimuth to azimuth",
                       aside_mm);
  if (!scene.source.is_round())
    return "the source is not round, so the light differs from azimuth to azimuth";
  if (scene.source.tilt_rad() > tolerance.angle_rad)
    return fmt::format("the source's axis is tilted by {:.4g} degrees against the mirror's",
                       scene.source.tilt_rad() * 180 / pi);
  const double tilt_rad = std::asin(std::min(1.0, field.normal().head<2>().norm()));
  if (tilt_rad > tolerance.angle_rad)
    return fmt::format("the near field is tilted by {:.4g} degrees against a plane across the axis",
                       tilt_rad * 180 / pi);
  if (!field.material()) return std::nullopt;
  if (field.shape() != NearField::Shape::disc)
    return "the near field is a real rectangle, which casts a shadow that differs from azimuth to azimuth";
  const double off_mm = field.center_mm().head<2>().norm();
  if (off_mm > tolerance.length_mm)
    return fmt::format("the near field is a real disc with its centre {:.4g} mm off the axis", off_mm);
  return std::nullopt;
}

struct RingPhotons::Parts {
  RingsOptions options;
  double cover_mm;
  double widest;  ///< bandwidth that the recorded range beyond the field's edge allows
  std::unique_ptr<RingStore> store;
  std::vector<double> powers;  ///< of a photon of each set
  RingsField landed;           ///< what does not depend on radii and bandwidth
};

RingPhotons::RingPhotons(const Scene& scene, const RingsOptions& options) {
  check(scene, options);
  const double cover_mm = farthest_radius_mm(scene.near_field), cover = cover_mm * cover_mm;
  // Estimates at the field's edge look beyond it; a bandwidth to be chosen is narrower than a quarter.
  const double margin = options.bandwidth_mm2 ? std::min(*options.bandwidth_mm2, cover) : 0.25 * cover;
  const double out_mm = cover_mm + options.widest_kernel_radius_mm;
  const double end = scene.near_field.material() ? cover : std::max(cover + margin, out_mm * out_mm);
  parts_.reset(new Parts{options, cover_mm, margin, nullptr, {}, {}});
  const Sets sets(scene, options);
  const auto cuts = cuts_for(scene, options, end);
  for (std::size_t i = 1; i + 1 < cuts.size(); ++i) parts_->landed.edges_mm.push_back(std::sqrt(cuts[i]));
  parts_->store = sets.store(cuts);
  parts_->powers = sets.fly(*parts_->store, std::sqrt(end), parts_->landed);
  parts_->landed.replicates = options.photons.photons > 0 ? parts_->powers.size() : 0;
}
RingPhotons::~RingPhotons() = default;
RingPhotons::RingPhotons(RingPhotons&&) noexcept = default;

double RingPhotons::widest_bandwidth_mm2() const { return parts_->widest; }
double RingPhotons::least_bandwidth_mm2() const { return parts_->store->least_bandwidth(); }
const EnergyLedger& RingPhotons::energy() const { return parts_->landed.energy; }
const PhotonCounts& RingPhotons::counts() const { return parts_->landed.counts; }

RingsField RingPhotons::estimate(std::span<const double> radii_mm) {
  const double cover = parts_->cover_mm * parts_->cover_mm;
  const auto& wanted = parts_->options.bandwidth_mm2;
  RingsField field = estimate(
      radii_mm,
      wanted ? *wanted : choose_bandwidth(*parts_->store, parts_->powers, parts_->options.kernel, cover));
  for (auto* values : {&field.irradiance, &field.debiased})
    for (double& value : *values) value = std::max(0.0, value);
  return field;
}

RingsField RingPhotons::estimate(std::span<const double> radii_mm, double bandwidth_mm2) {
  check_radii(parts_->cover_mm, radii_mm);
  RingsField field = parts_->landed;
  field.bandwidth_mm2 = bandwidth_mm2;
  estimate_all(*parts_->store, parts_->powers, radii_mm, parts_->options, field);
  field.memory_bytes = parts_->store->memory_bytes();
  return field;
}

std::vector<double> RingPhotons::smoothed(std::span<const double> radii_mm, double kernel_radius_mm) const {
  check_radii(parts_->cover_mm, radii_mm);
  CATOPTRIC_EXPECTS(kernel_radius_mm > 0 && kernel_radius_mm <= parts_->options.widest_kernel_radius_mm);
  const std::size_t sets = parts_->powers.size();
  std::vector<double> mean(radii_mm.size(), 0.0);
  for (std::size_t set = 0; set < sets; ++set) {
    const auto field = smoothed_rings(parts_->store->places(set, widest_place_mm2(kernel_radius_mm)),
                                      parts_->powers[set], radii_mm, kernel_radius_mm);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += field[i] / static_cast<double>(sets);
  }
  const double end_mm = std::sqrt(parts_->store->end());
  const RecordedArea area{NearField::Shape::disc, end_mm, end_mm};
  for (std::size_t i = 0; i < mean.size(); ++i)
    mean[i] /=
        kernel_mass_inside(Kernel::silverman, kernel_radius_mm, area, {std::min(radii_mm[i], end_mm), 0});
  return mean;
}

RingStore::Places RingPhotons::landed(double widest_mm2) const {
  RingStore::Places all;
  for (std::size_t set = 0; set < parts_->powers.size(); ++set) {
    const RingStore::Places places = parts_->store->places(set, widest_mm2);
    all.squares.insert(all.squares.end(), places.squares.begin(), places.squares.end());
    all.photons.insert(all.photons.end(), places.photons.begin(), places.photons.end());
  }
  return all;
}

RingsField rings_field(const Scene& scene, std::span<const double> radii_mm, const RingsOptions& options) {
  check(scene, options);
  check_radii(farthest_radius_mm(scene.near_field), radii_mm);  // before any photon flies
  return RingPhotons(scene, options).estimate(radii_mm);
}

std::vector<double> ring_radii_mm(const NearField& field, std::span<const FieldSample> samples) {
  const double cover_mm = farthest_radius_mm(field);
  std::vector<double> radii;
  radii.reserve(samples.size());
  for (const FieldSample& sample : samples)
    radii.push_back(std::min(std::hypot(sample.point_mm.x(), sample.point_mm.y()), cover_mm));
  return radii;
}

}  // namespace catoptric::sim
