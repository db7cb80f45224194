#include "sim/ring_smoothing.h"

#include <algorithm>
#include <cmath>

#include "base/vector_clones.h"
#include "sim/side_by_side.h"
#include "sim/tube_kernel.h"

namespace catoptric::sim {
namespace {

constexpr std::size_t lanes = 8;

/// Sum over rings [first, last) as seen from one radius; lengths in kernel radii. Lanes are summed apart, so
/// that the loop is done in vector lanes in the same order on every machine.
CATOPTRIC_VECTOR_CLONES double seen_from(double at, const double* rings, const double* photons,
                                         std::size_t first, std::size_t last) {
  double sums[lanes] = {};
  std::size_t i = first;
  for (; i + lanes <= last; i += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane)
      sums[lane] += photons[i + lane] * kernel_ring_mean(at, rings[i + lane]).value;
  double sum = 0;
  for (; i < last; ++i) sum += photons[i] * kernel_ring_mean(at, rings[i]).value;
  for (const double each : sums) sum += each;
  return sum;
}

}  // namespace

std::vector<double> smoothed_rings(const RingStore::Places& places, double photon_power_w,
                                   std::span<const double> radii_mm, double kernel_radius_mm) {
  std::vector<double> rings(places.squares.size());
  for (std::size_t i = 0; i < rings.size(); ++i) rings[i] = std::sqrt(places.squares[i]) / kernel_radius_mm;
  const double scale = photon_power_w * kernel_peak_per_mm2(kernel_radius_mm);
  std::vector<double> values(radii_mm.size());
  constexpr std::size_t chunk = 32;
  side_by_side((radii_mm.size() + chunk - 1) / chunk, [&](std::size_t part) {
    for (std::size_t i = part * chunk; i < std::min(radii_mm.size(), (part + 1) * chunk); ++i) {
      const double at = radii_mm[i] / kernel_radius_mm;
      const auto first = std::lower_bound(rings.begin(), rings.end(), at - 1);
      const auto last = std::upper_bound(first, rings.end(), at + 1);
      values[i] = scale * seen_from(at, rings.data(), places.photons.data(),
                                    static_cast<std::size_t>(first - rings.begin()),
                                    static_cast<std::size_t>(last - rings.begin()));
    }
  });
  return values;
}

}  // namespace catoptric::sim
