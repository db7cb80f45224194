#include "sim/bandwidth_ladder.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/byte_record.h"
#include "base/contract.h"
#include "base/units.h"
#include "sim/flight_counts.h"
#include "sim/photon_map.h"
#include "sim/probes.h"
#include "sim/rings.h"
#include "sim/side_by_side.h"

namespace catoptric::sim {
namespace {

/// Photons of a slice of a set of rung photons, which one rank keeps: fewer would be looked at as long as
/// they flew. Not more slices, since what they show is sent.
constexpr std::uint64_t photons_of_a_slice = std::uint64_t{1} << 20, most_slices_of_a_set = 64;

std::uint64_t slices_of(std::uint64_t photons_of_a_set) {
  return std::clamp<std::uint64_t>(photons_of_a_set / photons_of_a_slice, 1, most_slices_of_a_set);
}

/// One slice seen with one bandwidth.
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

/// Sums of what the slices of each set say, sets in order.
SetFields summed(const std::vector<std::vector<double>>& by_slice, std::size_t slices_of_a_set) {
  SetFields sets;
  for (std::size_t slice = 0; slice < by_slice.size(); ++slice) {
    if (slice % slices_of_a_set == 0) {
      sets.push_back(by_slice[slice]);
      continue;
    }
    for (std::size_t i = 0; i < by_slice[slice].size(); ++i) sets.back()[i] += by_slice[slice][i];
  }
  return sets;
}

}  // namespace

double widest_kernel_radius_mm(const NearField& field) {
  return 0.70710678118654752 * std::min(field.half_width_mm(), field.half_height_mm());
}

std::uint64_t most_kept_by_a_rank(std::uint64_t photons, int ranks) {
  const std::uint64_t slices = sets_of_photons * slices_of(photons / sets_of_photons);
  const auto sharers = static_cast<std::uint64_t>(ranks);
  return std::min(photons, (photons + slices - 1) / slices * ((slices + sharers - 1) / sharers));
}

struct PhotonSets::Parts {
  const Scene& scene;
  Rung rung;
  std::optional<PhotonFlights> flights;  ///< of rung photons
  FieldCells cells;
  Ranks* ranks = &lone_process();
  std::size_t slices_of_a_set = 1;
  // By slice; of those that this rank keeps.
  std::vector<std::optional<PhotonMap>> maps = {};
  std::vector<std::optional<RingPhotons>> rings = {};
  // Of all sets.
  double least_bandwidth_mm2 = 0;
  std::vector<double> light_by_cell = {};
  EnergyLedger energy = {};
  PhotonCounts counts = {};

  std::size_t slices() const { return std::max(maps.size(), rings.size()); }

  void forget() {
    maps.clear();
    rings.clear();
    energy = {};
    counts = {};
    light_by_cell.assign(FieldCells::count, 0.0);
  }

  /// What slices give, each computed by the rank that keeps it, in the order of the slices.
  std::vector<Bytes> of_slices(const std::function<Bytes(std::size_t slice)>& of_slice) const {
    const auto by_rank = ranks->each([&](std::size_t rank, std::size_t count) {
      std::vector<Bytes> own(slices() > rank ? (slices() - rank + count - 1) / count : 0);
      side_by_side(own.size(), [&](std::size_t i) { own[i] = of_slice(rank + i * count); });
      return ByteWriter().put(own).take();
    });
    const std::size_t sharers = by_rank.size();
    std::vector<Bytes> all(slices());
    for (std::size_t rank = 0; rank < sharers; ++rank) {
      auto own = ByteReader(by_rank[rank]).get<std::vector<Bytes>>();
      for (std::size_t i = 0; i < own.size(); ++i) all[rank + i * sharers] = std::move(own[i]);
    }
    return all;
  }

  void take(const FlightTotals& of_set, std::size_t sets) {
    energy.add(of_set.energy, 1.0 / static_cast<double>(sets));
    counts.add(of_set.counts);
  }

  void take_light(ByteReader& of_slice) {
    const auto light = of_slice.get<std::vector<double>>();
    for (std::size_t cell = 0; cell < light.size(); ++cell) light_by_cell[cell] += light[cell];
  }

  /// Of one slice's photons, some of which are asked; whole numbers.
  std::vector<double> light_of(const PhotonMap& map) const {
    constexpr std::size_t photons_of_a_set = 1024, fewest = 16;
    std::vector<double> light(FieldCells::count, 0.0);
    for (const StoredPhoton& photon : map.some(std::max(fewest, photons_of_a_set / slices_of_a_set)))
      if (const Vector2 at{photon.x_mm, photon.y_mm}; scene.near_field.contains(at)) light[cells.at(at)] += 1;
    return light;
  }

  std::vector<double> light_of(const RingPhotons& set) const {
    std::vector<double> light(FieldCells::count, 0.0);
    const double reach_mm = cells.reach_mm(), cell_mm2 = reach_mm * reach_mm / FieldCells::count;
    const RingStore::Places places = set.landed(cell_mm2);
    for (std::size_t i = 0; i < places.squares.size(); ++i)
      if (const double radius_mm = std::sqrt(places.squares[i]); radius_mm <= reach_mm)
        light[cells.at(radius_mm)] += places.photons[i];
    return light;
  }

  void fly_to_maps(const PhotonOptions& options, std::size_t sets, double widest_radius_mm) {
    check(options);
    flights->record(RecordedArea::about(scene.near_field, widest_radius_mm));
    slices_of_a_set = slices_of(options.photons);
    maps.resize(sets * slices_of_a_set);
    const std::uint64_t chunks = PhotonFlights::chunks(options.photons);
    const auto from_slices = of_slices([&](std::size_t slice) {
      PhotonOptions photons = options;
      photons.stream += slice / slices_of_a_set;
      const std::uint64_t part = slice % slices_of_a_set;
      FlightCounts counted;
      maps[slice].emplace(scene.near_field, trace_chunks(*flights, photons, chunks * part / slices_of_a_set,
                                                         chunks * (part + 1) / slices_of_a_set, counted));
      return ByteWriter().put(counted).put(light_of(*maps[slice])).take();
    });
    for (std::size_t set = 0; set < sets; ++set) {
      FlightCounts counted;
      for (std::size_t part = 0; part < slices_of_a_set; ++part) {
        ByteReader reader(from_slices[set * slices_of_a_set + part]);
        counted.add(reader.get<FlightCounts>());
        take_light(reader);
      }
      take(flights->totals(options.photons, counted), sets);
    }
  }

  void fly_to_rings(const PhotonOptions& options, std::size_t sets) {
    slices_of_a_set = 1;
    rings.resize(sets);
    for (const Bytes& bytes : of_slices([&](std::size_t set) {
           RingsOptions ring_options;
           ring_options.photons = options;
           ring_options.photons.stream += set;
           ring_options.replicates = 1;
           const RingPhotons& flown = rings[set].emplace(scene, ring_options);
           return ByteWriter()
               .put(flown.energy())
               .put(flown.counts())
               .put(flown.least_bandwidth_mm2())
               .put(light_of(flown))
               .take();
         })) {
      ByteReader reader(bytes);
      FlightTotals totals;
      reader.get(totals.energy).get(totals.counts).get(least_bandwidth_mm2);
      take(totals, sets);
      take_light(reader);
    }
  }

  /// Narrower than its bins a store shows no change, which would read as convergence.
  std::size_t resolved(double widest_radius_mm, std::size_t levels) const {
    if (rung != Rung::rings) return levels;
    while (levels > 2 && bandwidth_mm2(radius_at(widest_radius_mm, levels - 1)) < least_bandwidth_mm2)
      --levels;
    return levels;
  }

  /// What one slice shows.
  std::vector<Look> look(std::size_t slice, std::span<const FieldSample> samples,
                         std::span<const double> radii_mm, double widest_radius_mm, std::size_t levels) {
    return rung == Rung::rings ? look_at_rings(*rings[slice], radii_mm, widest_radius_mm, levels)
                               : look_at_map(*maps[slice], samples, widest_radius_mm, levels);
  }

  /// One reading of one slice; a map's second order takes one sum of weights, not two.
  std::vector<double> field(std::size_t slice, std::span<const FieldSample> samples,
                            std::span<const double> radii_mm, double kernel_radius_mm, int order) {
    if (rung != Rung::rings && order == 2)
      return std::move(maps[slice]->ladder(samples, kernel_radius_mm, 1).front());
    Look look = std::move(this->look(slice, samples, radii_mm, kernel_radius_mm, 1).front());
    return std::move(order == 2 ? look.second : look.fourth);
  }

  std::vector<double> radii_mm(std::span<const FieldSample> samples) const {
    return rung == Rung::rings ? ring_radii_mm(scene.near_field, samples) : std::vector<double>();
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
  parts_->forget();
  parts_->ranks = options.ranks ? options.ranks : &lone_process();
  if (parts_->rung == Rung::rings)
    parts_->fly_to_rings(options, sets);
  else
    parts_->fly_to_maps(options, sets, widest_radius_mm);
}

BandwidthLadder PhotonSets::look(std::span<const FieldSample> samples, double widest_radius_mm,
                                 std::size_t levels) const {
  CATOPTRIC_EXPECTS(levels > 0 && parts_->slices() > 0);
  BandwidthLadder ladder(parts_->resolved(widest_radius_mm, levels));
  for (std::size_t level = 0; level < ladder.size(); ++level) {
    const double radius_mm = radius_at(widest_radius_mm, level);
    ladder[level].kernel_radius_mm = radius_mm;
    ladder[level].independent = std::clamp(parts_->scene.near_field.area_mm2() / (pi * radius_mm * radius_mm),
                                           1.0, static_cast<double>(samples.size()));
  }
  const std::vector<double> radii_mm = parts_->radii_mm(samples);
  const auto from_slices = parts_->of_slices([&](std::size_t slice) {
    ByteWriter writer;
    for (const Look& each : parts_->look(slice, samples, radii_mm, widest_radius_mm, ladder.size()))
      writer.put(each.second).put(each.fourth);
    return writer.take();
  });
  std::vector<std::vector<std::vector<double>>> second(ladder.size()), fourth(ladder.size());
  for (const Bytes& bytes : from_slices) {
    ByteReader reader(bytes);
    for (std::size_t level = 0; level < ladder.size(); ++level) {
      second[level].push_back(reader.get<std::vector<double>>());
      fourth[level].push_back(reader.get<std::vector<double>>());
    }
  }
  for (std::size_t level = 0; level < ladder.size(); ++level) {
    ladder[level].second = summed(second[level], parts_->slices_of_a_set);
    ladder[level].fourth = summed(fourth[level], parts_->slices_of_a_set);
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

const std::vector<double>& PhotonSets::light_by_cell() const { return parts_->light_by_cell; }

SetFields PhotonSets::fields(std::span<const FieldSample> samples, double kernel_radius_mm, int order) const {
  CATOPTRIC_EXPECTS(order == 2 || order == 4);
  const std::vector<double> radii_mm = parts_->radii_mm(samples);
  std::vector<std::vector<double>> by_slice;
  for (const Bytes& bytes : parts_->of_slices([&](std::size_t slice) {
         return ByteWriter().put(parts_->field(slice, samples, radii_mm, kernel_radius_mm, order)).take();
       }))
    by_slice.push_back(ByteReader(bytes).get<std::vector<double>>());
  return summed(by_slice, parts_->slices_of_a_set);
}

const EnergyLedger& PhotonSets::energy() const { return parts_->energy; }
const PhotonCounts& PhotonSets::counts() const { return parts_->counts; }

}  // namespace catoptric::sim
