#include "sim/bandwidth_ladder.h"

#include <algorithm>
#include <cmath>

#include "base/contract.h"
#include "base/units.h"
#include "sim/photon_map.h"
#include "sim/rings.h"

namespace catoptric::sim {
namespace {

double radius_at(const LadderOptions& options, std::size_t level) {
  return options.widest_radius_mm * std::pow(0.5, 0.5 * static_cast<double>(level));
}

void look_at_map(const Scene& scene, std::span<const FieldSample> samples, const LadderOptions& options,
                 const PhotonOptions& photons, BandwidthLadder& ladder) {
  TracedPhotons traced = trace_photons(scene, photons, options.widest_radius_mm);
  ladder.energy.add(traced.energy, 1.0 / static_cast<double>(options.sets));
  ladder.counts.add(traced.counts);
  const PhotonMap map(scene.near_field, std::move(traced));
  const auto look = [&](std::size_t level) {
    return map.estimate(samples, {Kernel::silverman, {}, radius_at(options, level)}).irradiance;
  };
  std::vector<double> wide = look(0);
  for (std::size_t level = 0; level < ladder.levels.size(); ++level) {
    std::vector<double> narrow = look(level + 1), fourth(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) fourth[i] = 2 * narrow[i] - wide[i];
    ladder.levels[level].second.push_back(std::move(wide));
    ladder.levels[level].fourth.push_back(std::move(fourth));
    wide = std::move(narrow);
  }
}

void look_at_rings(const Scene& scene, std::span<const FieldSample> samples, const LadderOptions& options,
                   const PhotonOptions& photons, BandwidthLadder& ladder) {
  RingsOptions rings;
  rings.photons = photons;
  rings.replicates = 1;
  RingPhotons set(scene, rings);
  // Narrower than its bins a store shows no change, which would read as convergence.
  while (ladder.levels.size() > 2 &&
         0.5 * ladder.levels.back().kernel_radius_mm * ladder.levels.back().kernel_radius_mm <
             set.least_bandwidth_mm2())
    ladder.levels.pop_back();
  ladder.energy.add(set.energy(), 1.0 / static_cast<double>(options.sets));
  ladder.counts.add(set.counts());
  const std::vector<double> radii = ring_radii_mm(scene.near_field, samples);
  for (LadderLevel& level : ladder.levels) {
    const double bandwidth = 0.5 * level.kernel_radius_mm * level.kernel_radius_mm;
    RingsField field = set.estimate(radii, std::min(bandwidth, set.widest_bandwidth_mm2()));
    level.second.push_back(std::move(field.irradiance));
    level.fourth.push_back(std::move(field.debiased));
  }
}

}  // namespace

double widest_kernel_radius_mm(const NearField& field) {
  return 0.5 * std::min(field.half_width_mm(), field.half_height_mm());
}

BandwidthLadder look_with_ladder(const Scene& scene, std::span<const FieldSample> samples,
                                 const LadderOptions& options) {
  CATOPTRIC_EXPECTS(options.rung != Rung::tubes && options.sets > 0 && options.widest_radius_mm > 0);
  BandwidthLadder ladder;
  ladder.levels.resize(options.levels);
  for (std::size_t level = 0; level < options.levels; ++level) {
    const double radius_mm = radius_at(options, level);
    ladder.levels[level].kernel_radius_mm = radius_mm;
    ladder.levels[level].independent =
        std::max(1.0, scene.near_field.area_mm2() / (pi * radius_mm * radius_mm));
  }
  for (std::size_t set = 0; set < options.sets; ++set) {
    PhotonOptions photons = options.photons;
    photons.stream += set;
    if (options.rung == Rung::rings)
      look_at_rings(scene, samples, options, photons, ladder);
    else
      look_at_map(scene, samples, options, photons, ladder);
  }
  return ladder;
}

}  // namespace catoptric::sim
