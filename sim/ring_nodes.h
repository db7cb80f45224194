#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/ring_kernel.h"
#include "sim/ring_store.h"

namespace catoptric::sim {

/// Photons of several sets in even bins of one segment.
struct RingBins {
  /// Sets that are summed at a time; the numbers of a bin are filled up with zeros to whole lanes.
  static constexpr std::size_t lanes = 4;
  static std::size_t row_of(std::size_t sets) { return (sets + lanes - 1) / lanes * lanes; }

  double bin_width = 0;  ///< in s
  std::size_t bins = 0, row = 0;
  std::unique_ptr<double[]> counts;  ///< by bin, `row` numbers each
};

/// A cubic through a one-sided window needs four bins; with twice as many it is well conditioned.
inline constexpr double fewest_bins_per_bandwidth = 8;

/// Density estimates at the nodes of a segment, the edges of its even bins, and between them by cubic
/// interpolation over four nodes. At nodes that see no end of the segment all windows are alike, so that one
/// set of weights serves them all, and a sum over a window is the same few operations for several sets at a
/// time. The interpolation is exact for cubics, so that densities that the nodes see exactly stay exact; of
/// others it leaves at most 5/128 bin^4 times the fourth derivative.
class RingNodes {
 public:
  /// @in a bandwidth of no more than the segment and most_bins_per_bandwidth bins, which is widened to
  ///     fewest_bins_per_bandwidth of them
  RingNodes(RingBins photons, RingKernel kernel, double bandwidth);

  /// A place as the cubic through four nodes sees it, or a node as it is.
  struct Reading {
    std::size_t first, count;      ///< nodes
    std::array<double, 4> weight;  ///< of each
  };
  double bin_width() const { return photons_.bin_width; }

  /// @in    place in bins from the segment's low end, up to all bins
  Reading between(double place) const {
    const std::size_t below = static_cast<std::uint32_t>(place);
    const std::size_t node = std::min(below - (below > 0), photons_.bins - 3);
    const double a = place - static_cast<double>(node), b = a - 1, c = a - 2, d = a - 3;
    return {node, 4, {b * c * d / -6, a * c * d / 2, a * b * d / -2, a * b * c / 6}};
  }
  Reading nearest(double place) const {
    return {std::min<std::size_t>(static_cast<std::uint32_t>(place + 0.5), photons_.bins), 1, {1}};
  }

  /// What will be read, before estimate().
  void want(const Reading& reading) {
    std::fill_n(wanted_.begin() + static_cast<std::ptrdiff_t>(reading.first), reading.count, char{1});
  }
  /// For all that is wanted so far, in parallel.
  void estimate();
  /// Safe to call from several threads after estimate().
  void read(const Reading& reading, RingDensity& out) const;

  static constexpr std::size_t most_bins_per_bandwidth = 64;

 private:
  static constexpr std::size_t window = 2 * most_bins_per_bandwidth;
  /// What a photon in each bin of a window counts.
  struct Weights {
    std::array<double, window> second, fourth;
  };
  Weights weights_for(std::size_t first, std::size_t last) const;
  void estimate_node(std::size_t node);
  std::size_t node_row() const { return 2 * photons_.row + 2; }

  RingBins photons_;
  std::size_t reach_;                                   ///< bins of a window on either side of a node
  std::array<double, window> u_, kernel_;               ///< by bin of a whole window
  std::array<RingMoments, window + 1> moments_before_;  ///< of the bins before each
  Weights whole_;                                       ///< of a window that sees no end
  std::vector<char> wanted_;                            ///< by node
  std::unique_ptr<double[]> nodes_;  ///< by node: second and fourth order by set, their squares
};

}  // namespace catoptric::sim
