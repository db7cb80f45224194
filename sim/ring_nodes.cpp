#include "sim/ring_nodes.h"

#include <algorithm>
#include <cmath>

#include "base/contract.h"
#include "base/vector_clones.h"
#include "sim/side_by_side.h"

namespace catoptric::sim {
namespace {

/// Numbers of several sets, which a processor takes together; read from and written to rows of doubles.
using Lanes = double __attribute__((vector_size(RingBins::lanes * sizeof(double)), aligned(8), may_alias));

/// Sums over a part of a window.
struct WindowSums {
  Lanes second{}, fourth{}, second_square{}, fourth_square{};
  [[gnu::always_inline]] void add(const Lanes& count, double weight2, double weight4) {
    const Lanes part2 = weight2 * count, part4 = weight4 * count;
    second += part2;
    fourth += part4;
    second_square += weight2 * part2;
    fourth_square += weight4 * part4;
  }
};

/// Sums over a window, for the sets of a row; then those of the squares over all sets. Even and odd bins are
/// summed apart: a sum would otherwise wait for the one before.
CATOPTRIC_VECTOR_CLONES
void weigh(const double* counts, std::size_t row, std::size_t bins, const double* second,
           const double* fourth, double* sums) {
  double second_square = 0, fourth_square = 0;
  for (std::size_t set = 0; set < row; set += RingBins::lanes) {
    const auto count_of = [&](std::size_t bin) __attribute__((always_inline))->const Lanes& {
      return *reinterpret_cast<const Lanes*>(counts + bin * row + set);
    };
    WindowSums even, odd;
    for (std::size_t bin = 0; bin + 1 < bins; bin += 2) {
      even.add(count_of(bin), second[bin], fourth[bin]);
      odd.add(count_of(bin + 1), second[bin + 1], fourth[bin + 1]);
    }
    if (bins % 2 != 0) even.add(count_of(bins - 1), second[bins - 1], fourth[bins - 1]);
    *reinterpret_cast<Lanes*>(sums + set) = even.second + odd.second;
    *reinterpret_cast<Lanes*>(sums + row + set) = even.fourth + odd.fourth;
    for (std::size_t lane = 0; lane < RingBins::lanes; ++lane) {
      second_square += even.second_square[lane] + odd.second_square[lane];
      fourth_square += even.fourth_square[lane] + odd.fourth_square[lane];
    }
  }
  sums[2 * row] = second_square;
  sums[2 * row + 1] = fourth_square;
}

/// What the nodes say, weighted and added up: orders by set, and their squares.
CATOPTRIC_VECTOR_CLONES
void blend(const double* nodes, std::size_t row, const RingNodes::Reading& reading, double* second,
           double* fourth, double* squares) {
  const std::size_t node_row = 2 * row + 2;
  for (std::size_t set = 0; set < row; set += RingBins::lanes) {
    Lanes sum2{}, sum4{};
    for (std::size_t i = 0; i < reading.count; ++i) {
      const double* node = nodes + i * node_row + set;
      sum2 += reading.weight[i] * *reinterpret_cast<const Lanes*>(node);
      sum4 += reading.weight[i] * *reinterpret_cast<const Lanes*>(node + row);
    }
    *reinterpret_cast<Lanes*>(second + set) = sum2;
    *reinterpret_cast<Lanes*>(fourth + set) = sum4;
  }
  for (std::size_t i = 0; i < reading.count; ++i)
    for (std::size_t order = 0; order < 2; ++order)
      squares[order] += reading.weight[i] * nodes[i * node_row + 2 * row + order];
}

}  // namespace

RingNodes::RingNodes(RingBins photons, RingKernel kernel, double bandwidth) : photons_(std::move(photons)) {
  const double widened = std::max(bandwidth / photons_.bin_width,
                                  std::min(fewest_bins_per_bandwidth, static_cast<double>(photons_.bins)));
  reach_ = static_cast<std::size_t>(widened + 0.5);  // bins whose middle is within the bandwidth
  CATOPTRIC_EXPECTS(reach_ <= most_bins_per_bandwidth && reach_ <= photons_.bins);
  moments_before_[0] = {};
  for (std::size_t bin = 0; bin < 2 * reach_; ++bin) {
    u_[bin] = (static_cast<double>(bin) - static_cast<double>(reach_) + 0.5) / widened;
    kernel_[bin] = ring_kernel(kernel, u_[bin]);
    double term = kernel_[bin];
    for (std::size_t j = 0; j < moments_before_[0].size(); ++j) {
      moments_before_[bin + 1][j] = moments_before_[bin][j] + term;
      term *= u_[bin];
    }
  }
  whole_ = weights_for(0, 2 * reach_);
  wanted_.assign(photons_.bins + 1, 0);
}

RingNodes::Weights RingNodes::weights_for(std::size_t first, std::size_t last) const {
  // Moments by the bins themselves, so that a straight (or cubic) density is seen exactly through them.
  RingMoments moments;
  for (std::size_t j = 0; j < moments.size(); ++j)
    moments[j] = moments_before_[last][j] - moments_before_[first][j];
  const auto second = boundary_polynomial(moments, 2), fourth = boundary_polynomial(moments, 4);
  Weights weights;
  for (std::size_t bin = first; bin < last; ++bin) {
    const double weight = kernel_[bin] / photons_.bin_width;
    weights.second[bin - first] = weight * second(u_[bin]);
    weights.fourth[bin - first] = weight * fourth(u_[bin]);
  }
  return weights;
}

void RingNodes::estimate() {
  nodes_ = std::make_unique_for_overwrite<double[]>(wanted_.size() * node_row());  // what is wanted is set
  constexpr std::size_t chunk = 128;
  side_by_side((wanted_.size() + chunk - 1) / chunk, [&](std::size_t part) {
    for (std::size_t node = part * chunk; node < std::min(wanted_.size(), (part + 1) * chunk); ++node)
      if (wanted_[node]) estimate_node(node);
  });
}

void RingNodes::estimate_node(std::size_t node) {
  const std::size_t first = node < reach_ ? reach_ - node : 0;  // bins of the whole window
  const std::size_t last = std::min(2 * reach_, photons_.bins - node + reach_);
  const double* counts = photons_.counts.get() + (node + first - reach_) * photons_.row;
  double* sums = nodes_.get() + node * node_row();
  const auto weigh_with = [&](const Weights& weights) {
    weigh(counts, photons_.row, last - first, weights.second.data(), weights.fourth.data(), sums);
  };
  if (last - first == 2 * reach_)
    weigh_with(whole_);
  else
    weigh_with(weights_for(first, last));
}

void RingNodes::read(const Reading& reading, RingDensity& out) const {
  const std::size_t row = photons_.row;
  out.second_order.resize(row);
  out.fourth_order.resize(row);
  double squares[2] = {};
  const double* nodes = nodes_.get() + reading.first * node_row();
  blend(nodes, row, reading, out.second_order.data(), out.fourth_order.data(), squares);
  // The weights' squares are those of nodes, not of their blend, which is as noisy to within a hundredth; a
  // cubic through zeros and few photons may dip below.
  out.second_square = std::max(0.0, squares[0]);
  out.fourth_square = std::max(0.0, squares[1]);
}

}  // namespace catoptric::sim
