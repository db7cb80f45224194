#include "sim/ring_store.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/contract.h"

namespace catoptric::sim {
namespace {

/// Bins across one bandwidth after merging: the bins then widen a kernel of variance h^2/7 by h^2/3000.
constexpr double bins_per_bandwidth = 16;
/// A cubic through a one-sided window needs four bins; with twice as many it is well conditioned.
constexpr double fewest_bins_per_bandwidth = 8;
constexpr std::size_t fewest_bins = 64;

/// A window holds fewer than two bandwidths of twice bins_per_bandwidth, or a whole segment of fewest_bins.
constexpr int most_bins_of_window = 128;
using BinArray = Eigen::Array<double, Eigen::Dynamic, 1, 0, most_bins_of_window, 1>;

void reset(RingDensities& out, std::size_t sets) {
  out.second_order.assign(sets, 0.0);
  out.fourth_order.assign(sets, 0.0);
  out.second_square = out.fourth_square = 0;
}

}  // namespace

RingStore::Window RingStore::window(double s, double bandwidth) const {
  const auto after = std::upper_bound(cuts_.begin() + 1, cuts_.end() - 1, s);
  const double low = *std::prev(after), high = *after;
  return {static_cast<std::size_t>(after - cuts_.begin()) - 1, std::min(bandwidth, high - low), low, high};
}

SortedRings::SortedRings(std::vector<double> cuts, std::size_t sets, std::span<const std::uint64_t> chunks)
    : RingStore(std::move(cuts), sets), squares_(sets) {
  for (std::uint64_t count : chunks) parts_.emplace_back(count);
}

void SortedRings::add(std::size_t set, std::uint64_t chunk, std::span<const double> squares) {
  std::vector<double>& part = parts_[set][chunk];
  for (double s : squares)
    if (s <= end()) part.push_back(s);
}

void SortedRings::close() {
  for (std::size_t set = 0; set < sets_; ++set) {
    for (auto& part : parts_[set]) squares_[set].insert(squares_[set].end(), part.begin(), part.end());
    std::sort(squares_[set].begin(), squares_[set].end());
  }
  parts_.clear();
}

double SortedRings::least_bandwidth() const {
  // Below the distance of a handful of photons an estimate is noise alone.
  std::size_t photons = 0;
  for (const auto& set : squares_) photons += set.size();
  return end() * std::min(1.0, 4.0 / static_cast<double>(std::max<std::size_t>(photons, 1)));
}

std::size_t SortedRings::memory_bytes() const {
  std::size_t photons = 0;
  for (const auto& set : squares_) photons += set.capacity();
  return photons * sizeof(double);
}

void SortedRings::estimate(double s, RingKernel kernel, double bandwidth, RingDensities& out) const {
  reset(out, sets_);
  const Window at = window(s, bandwidth);
  const double from = std::max(at.low, s - at.bandwidth), to = std::min(at.high, s + at.bandwidth);
  const RingMoments moments = moments_between(kernel, (from - s) / at.bandwidth, (to - s) / at.bandwidth);
  const BoundaryPolynomial second = boundary_polynomial(moments, 2), fourth = boundary_polynomial(moments, 4);
  const double scale = 1 / at.bandwidth;
  for (std::size_t set = 0; set < sets_; ++set) {
    const auto& all = squares_[set];
    // A photon on a cut belongs to the segment above it.
    auto photon = std::lower_bound(all.begin(), all.end(), from);
    for (; photon != all.end() && (*photon < to || to == end()) && *photon <= to; ++photon) {
      const double u = (*photon - s) * scale, weight = scale * ring_kernel(kernel, u);
      const double w2 = weight * second(u), w4 = weight * fourth(u);
      out.second_order[set] += w2;
      out.fourth_order[set] += w4;
      out.second_square += w2 * w2;
      out.fourth_square += w4 * w4;
    }
  }
}

RingStore::Places SortedRings::places(std::size_t set, double) const {
  return {squares_[set], std::vector<double>(squares_[set].size(), 1.0)};
}

RingStore::Places CountedRings::places(std::size_t set, double widest) const {
  Places places;
  for (const Segment& segment : segments_) {
    const std::size_t wanted = std::bit_floor(static_cast<std::size_t>(
        std::clamp(widest * segment.per_mm2, 1.0, static_cast<double>(segment.bins))));
    const double width = static_cast<double>(wanted) / segment.per_mm2;
    const auto* count = counts_.data() + set * bins_ + segment.first;
    for (std::size_t bin = 0; bin < segment.bins; bin += wanted) {
      std::uint64_t sum = 0;
      for (std::size_t i = 0; i < wanted; ++i) sum += (count++)->load(std::memory_order_relaxed);
      places.squares.push_back(segment.low + (static_cast<double>(bin / wanted) + 0.5) * width);
      places.photons.push_back(static_cast<double>(sum));
    }
  }
  return places;
}

CountedRings::CountedRings(std::vector<double> cuts, std::size_t sets, std::size_t bins)
    : RingStore(std::move(cuts), sets) {
  for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
    const double width = cuts_[i + 1] - cuts_[i];
    const double share = static_cast<double>(bins) * width / end();
    const std::size_t count =
        std::max(fewest_bins, std::bit_ceil(static_cast<std::size_t>(std::ceil(share))));
    segments_.push_back({cuts_[i], width, static_cast<double>(count) / width, count, bins_, count, bins_});
    bins_ += count;
  }
  counts_ = std::vector<std::atomic<std::uint64_t>>(bins_ * sets_);
}

void CountedRings::add(std::size_t set, std::uint64_t, std::span<const double> squares) {
  std::atomic<std::uint64_t>* const counts = counts_.data() + set * bins_;
  for (double s : squares) {
    if (!(s <= end())) continue;
    const auto after = std::upper_bound(cuts_.begin() + 1, cuts_.end() - 1, s);
    const Segment& segment = segments_[static_cast<std::size_t>(after - cuts_.begin()) - 1];
    const std::size_t bin =
        std::min(segment.bins - 1, static_cast<std::size_t>((s - segment.low) * segment.per_mm2));
    counts[segment.first + bin].fetch_add(1, std::memory_order_relaxed);
  }
}

void CountedRings::prepare(double bandwidth) {
  std::size_t total = 0;
  for (Segment& segment : segments_) {
    const double wanted = bins_per_bandwidth * segment.width / std::min(bandwidth, segment.width);
    segment.merged_bins =
        std::min(segment.bins, std::max(fewest_bins, std::bit_ceil(static_cast<std::size_t>(std::min(
                                                         wanted, static_cast<double>(segment.bins))))));
    segment.merged_first = total;
    total += segment.merged_bins;
  }
  merged_bins_ = total;
  merged_.assign(total * (sets_ + 1), 0.0);
  for (const Segment& segment : segments_) {
    const std::size_t factor = segment.bins / segment.merged_bins;
    for (std::size_t set = 0; set < sets_; ++set) {
      const auto* count = counts_.data() + set * bins_ + segment.first;
      for (std::size_t bin = segment.merged_first; bin < segment.merged_first + segment.merged_bins; ++bin) {
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < factor; ++i) sum += (count++)->load(std::memory_order_relaxed);
        merged_[set * total + bin] = static_cast<double>(sum);
        merged_[sets_ * total + bin] += static_cast<double>(sum);
      }
    }
  }
}

double CountedRings::least_bandwidth() const {
  double widest_bin = 0;
  for (const Segment& segment : segments_) widest_bin = std::max(widest_bin, 1 / segment.per_mm2);
  return fewest_bins_per_bandwidth * widest_bin;
}

std::size_t CountedRings::memory_bytes() const {
  return counts_.size() * sizeof(counts_[0]) + merged_.capacity() * sizeof(double);
}

void CountedRings::estimate(double s, RingKernel kernel, double bandwidth, RingDensities& out) const {
  reset(out, sets_);
  const Window at = window(s, bandwidth);
  const Segment& segment = segments_[at.segment];
  const double bin_width = segment.width / static_cast<double>(segment.merged_bins);
  const double h = std::max(at.bandwidth, std::min(fewest_bins_per_bandwidth * bin_width, segment.width));
  const double place = (s - segment.low) / bin_width, reach = h / bin_width;
  const auto bin_at = [&](double bin) {
    return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(segment.merged_bins)));
  };
  const std::size_t first = bin_at(std::ceil(place - reach - 0.5)),
                    last = bin_at(std::floor(place + reach + 0.5));
  // Moments by the bins themselves, so that a straight (or cubic) density is seen exactly through them.
  const auto bins = static_cast<Eigen::Index>(last - first);
  const BinArray u = (BinArray::LinSpaced(bins, 0.0, static_cast<double>(bins - 1)) +
                      (static_cast<double>(first) + 0.5 - place)) /
                     reach;
  const BinArray rest = 1 - u * u;
  BinArray weight = kernel == RingKernel::biweight ? BinArray(rest * rest) : rest;
  RingMoments moments{};
  BinArray term = weight;
  for (double& moment : moments) {
    moment = term.sum();
    term *= u;
  }
  const auto weights_of = [&](int order) -> BinArray {
    const auto c = boundary_polynomial(moments, order).c;
    return weight / bin_width * (c[0] + u * (c[1] + u * (c[2] + u * c[3])));
  };
  const BinArray second = weights_of(2), fourth = weights_of(4);
  const auto counts_of = [&](std::size_t row) {
    return Eigen::Map<const Eigen::ArrayXd>(
        merged_.data() + row * merged_bins_ + segment.merged_first + first, bins);
  };
  for (std::size_t set = 0; set < sets_; ++set) {
    out.second_order[set] = (second * counts_of(set)).sum();
    out.fourth_order[set] = (fourth * counts_of(set)).sum();
  }
  out.second_square = (second.square() * counts_of(sets_)).sum();
  out.fourth_square = (fourth.square() * counts_of(sets_)).sum();
}

}  // namespace catoptric::sim
