#include "sim/bandwidth_ladder.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/contract.h"
#include "base/units.h"
#include "sim/photon_map.h"
#include "sim/probes.h"
#include "sim/rings.h"
#include "sim/side_by_side.h"

namespace catoptric::sim {
namespace {

/// One set seen with one bandwidth.
struct Look {
  std::vector<double> second, fourth;
};

double radius_at(double widest_radius_mm, std::size_t level) {
  return widest_radius_mm * std::pow(0.5, 0.5 * static_cast<double>(level));
}

FieldCells cells_for(const NearField& field, Rung rung) {
  return rung == Rung::rings ? FieldCells::rings(farthest_radius_mm(field)) : FieldCells::squares(field);
}

double bandwidth_mm2(double kernel_radius_mm) { return 0.5 * kernel_radius_mm * kernel_radius_mm; }

std::vector<Look> look_at_map(const PhotonMap& map, std::span<const FieldSample> samples,
                              double widest_radius_mm, std::size_t levels) {
  auto fields = map.ladder(samples, widest_radius_mm, levels + 1);
  std::vector<Look> looks(levels);
  for (std::size_t level = 0; level < levels; ++level) {
    const auto &wide = fields[level], &narrow = fields[level + 1];
    looks[level].fourth.resize(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) looks[level].fourth[i] = 2 * narrow[i] - wide[i];
    looks[level].second = std::move(fields[level]);
  }
  return looks;
}

std::vector<Look> look_at_rings(RingPhotons& set, std::span<const double> radii_mm, double widest_radius_mm,
                                std::size_t levels) {
  std::vector<Look> looks(levels);
  for (std::size_t level = 0; level < levels; ++level) {
    const double bandwidth = bandwidth_mm2(radius_at(widest_radius_mm, level));
    RingsField field = set.estimate(radii_mm, std::min(bandwidth, set.widest_bandwidth_mm2()));
    looks[level] = {std::move(field.irradiance), std::move(field.debiased)};
  }
  return looks;
}

}  // namespace

double widest_kernel_radius_mm(const NearField& field) {
  return 0.70710678118654752 * std::min(field.half_width_mm(), field.half_height_mm());
}

struct PhotonSets::Parts {
  const Scene& scene;
  Rung rung;
  std::optional<PhotonFlights> flights;  ///< of rung photons
  FieldCells cells;
  std::vector<PhotonMap> maps = {};
  std::vector<RingPhotons> rings = {};
  EnergyLedger energy = {};
  PhotonCounts counts = {};

  std::size_t sets() const { return rung == Rung::rings ? rings.size() : maps.size(); }

  void add(const EnergyLedger& of_set, const PhotonCounts& counted, std::size_t sets) {
    energy.add(of_set, 1.0 / static_cast<double>(sets));
    counts.add(counted);
  }

  void fly_to_maps(const PhotonOptions& options, std::size_t sets, double widest_radius_mm) {
    flights->record(RecordedArea::about(scene.near_field, widest_radius_mm));
    std::vector<TracedPhotons> traced(sets);
    std::vector<std::optional<PhotonMap>> built(sets);
    side_by_side(sets, [&](std::size_t set) {
      PhotonOptions photons = options;
      photons.stream += set;
      traced[set] = trace_photons(*flights, photons);
      built[set].emplace(scene.near_field, std::move(traced[set]));
    });
    for (std::size_t set = 0; set < sets; ++set) {
      add(traced[set].energy, traced[set].counts, sets);
      maps.push_back(std::move(*built[set]));
    }
  }

  void fly_to_rings(const PhotonOptions& options, std::size_t sets) {
    for (std::size_t set = 0; set < sets; ++set) {
      RingsOptions ring_options;
      ring_options.photons = options;
      ring_options.photons.stream += set;
      ring_options.replicates = 1;
      rings.emplace_back(scene, ring_options);
      add(rings.back().energy(), rings.back().counts(), sets);
    }
  }

  /// Narrower than its bins a store shows no change, which would read as convergence.
  std::size_t resolved(double widest_radius_mm, std::size_t levels) const {
    if (rings.empty()) return levels;
    while (levels > 2 &&
           bandwidth_mm2(radius_at(widest_radius_mm, levels - 1)) < rings.front().least_bandwidth_mm2())
      --levels;
    return levels;
  }
};

PhotonSets::PhotonSets(const Scene& scene, Rung rung)
    : parts_(new Parts{scene, rung, {}, cells_for(scene.near_field, rung)}) {
  CATOPTRIC_EXPECTS(rung != Rung::tubes);
  if (rung == Rung::photons) parts_->flights.emplace(scene, RecordedArea::about(scene.near_field, 0));
}
PhotonSets::~PhotonSets() = default;

void PhotonSets::fly(const PhotonOptions& options, std::size_t sets, double widest_radius_mm) {
  CATOPTRIC_EXPECTS(sets > 0 && widest_radius_mm > 0);
  parts_->maps.clear();
  parts_->rings.clear();
  parts_->energy = {};
  parts_->counts = {};
  if (parts_->rung == Rung::rings)
    parts_->fly_to_rings(options, sets);
  else
    parts_->fly_to_maps(options, sets, widest_radius_mm);
}

BandwidthLadder PhotonSets::look(std::span<const FieldSample> samples, double widest_radius_mm,
                                 std::size_t levels) const {
  CATOPTRIC_EXPECTS(levels > 0 && !(parts_->maps.empty() && parts_->rings.empty()));
  BandwidthLadder ladder(parts_->resolved(widest_radius_mm, levels));
  for (std::size_t level = 0; level < ladder.size(); ++level) {
    const double radius_mm = radius_at(widest_radius_mm, level);
    ladder[level].kernel_radius_mm = radius_mm;
    ladder[level].independent = std::clamp(parts_->scene.near_field.area_mm2() / (pi * radius_mm * radius_mm),
                                           1.0, static_cast<double>(samples.size()));
  }
  const bool by_rings = parts_->rung == Rung::rings;
  std::vector<double> radii;
  if (by_rings) radii = ring_radii_mm(parts_->scene.near_field, samples);
  std::vector<std::vector<Look>> sets(parts_->sets());
  side_by_side(sets.size(), [&](std::size_t set) {
    sets[set] = by_rings ? look_at_rings(parts_->rings[set], radii, widest_radius_mm, ladder.size())
                         : look_at_map(parts_->maps[set], samples, widest_radius_mm, ladder.size());
  });
  for (auto& set : sets)
    for (std::size_t level = 0; level < ladder.size(); ++level) {
      ladder[level].second.push_back(std::move(set[level].second));
      ladder[level].fourth.push_back(std::move(set[level].fourth));
    }
  return ladder;
}

std::vector<std::uint32_t> PhotonSets::cells_of(std::span<const FieldSample> samples) const {
  const NearField& field = parts_->scene.near_field;
  std::vector<std::uint32_t> cells;
  cells.reserve(samples.size());
  if (parts_->rung == Rung::rings)
    for (const double radius_mm : ring_radii_mm(field, samples)) cells.push_back(parts_->cells.at(radius_mm));
  else
    for (const FieldSample& sample : samples)
      cells.push_back(parts_->cells.at(field.to_plane(sample.point_mm)));
  return cells;
}

std::vector<double> PhotonSets::light_by_cell() const {
  constexpr std::size_t photons_of_a_set = 1024;
  std::vector<double> light(FieldCells::count, 0.0);
  for (const PhotonMap& map : parts_->maps)
    for (const StoredPhoton& photon : map.some(photons_of_a_set))
      if (const Vector2 at{photon.x_mm, photon.y_mm}; parts_->scene.near_field.contains(at))
        light[parts_->cells.at(at)] += 1;
  for (const RingPhotons& rings : parts_->rings) {
    const double reach_mm = parts_->cells.reach_mm(), cell_mm2 = reach_mm * reach_mm / FieldCells::count;
    const RingStore::Places places = rings.landed(cell_mm2);
    for (std::size_t i = 0; i < places.squares.size(); ++i)
      if (const double radius_mm = std::sqrt(places.squares[i]); radius_mm <= reach_mm)
        light[parts_->cells.at(radius_mm)] += places.photons[i];
  }
  return light;
}

SetFields PhotonSets::fields(std::span<const FieldSample> samples, double kernel_radius_mm, int order) const {
  CATOPTRIC_EXPECTS(order == 2 || order == 4);
  SetFields sets(parts_->sets());
  std::vector<double> radii;
  if (!parts_->rings.empty()) radii = ring_radii_mm(parts_->scene.near_field, samples);
  side_by_side(sets.size(), [&](std::size_t set) {
    if (!radii.empty()) {
      Look look = std::move(look_at_rings(parts_->rings[set], radii, kernel_radius_mm, 1).front());
      sets[set] = std::move(order == 2 ? look.second : look.fourth);
      return;
    }
    auto levels = parts_->maps[set].ladder(samples, kernel_radius_mm, order == 2 ? 1 : 2);
    sets[set] = std::move(levels.front());
    for (std::size_t i = 0; order == 4 && i < samples.size(); ++i)
      sets[set][i] = 2 * levels[1][i] - sets[set][i];
  });
  return sets;
}

const EnergyLedger& PhotonSets::energy() const { return parts_->energy; }
const PhotonCounts& PhotonSets::counts() const { return parts_->counts; }

}  // namespace catoptric::sim
