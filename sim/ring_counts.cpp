#include "sim/ring_counts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>

#include "sim/side_by_side.h"

namespace catoptric::sim {
namespace {

/// Bins across one bandwidth after merging: the bins then widen a kernel of variance h^2/7 by h^2/3000.
constexpr double bins_per_bandwidth = 16;
/// Of a segment; merged bins never outnumber twice bins_per_bandwidth or a whole segment of these.
constexpr std::size_t fewest_bins = RingNodes::most_bins_per_bandwidth;

}  // namespace

CountedRings::CountedRings(std::vector<double> cuts, std::size_t sets, std::size_t bins)
    : RingStore(std::move(cuts), sets) {
  for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
    const double width = cuts_[i + 1] - cuts_[i];
    const double share = static_cast<double>(bins) * width / end();
    const auto count = static_cast<std::uint32_t>(
        std::max(fewest_bins, std::bit_ceil(static_cast<std::size_t>(std::ceil(share)))));
    segments_.push_back({cuts_[i], cuts_[i + 1], static_cast<double>(count) / width, count, bins_});
    bins_ += count;
  }
  counts_.resize(sets_ * (bins_ + 1));
}

void CountedRings::add(std::size_t set, std::uint64_t, std::span<const double> squares) {
  std::vector<std::uint32_t> bins(squares.size());
  std::size_t count = 0;
  const Segment* segment = segments_.data();
  for (double s : squares) {
    if (!(s <= end())) continue;
    // Mostly the segment of the photon before.
    if (!(s >= segment->low && s < segment->high)) segment = &segments_[segment_of(s)];
    const auto bin = static_cast<std::uint32_t>((s - segment->low) * segment->per_mm2);
    bins[count++] = segment->first + std::min(segment->bins - 1, bin);
  }
  std::int64_t* const after = counts_.data() + set * (bins_ + 1) + 1;
  const std::lock_guard lock(mutex_);
  for (std::uint32_t bin : std::span(bins.data(), count)) ++after[bin];
}

void CountedRings::close() {
  for (std::size_t set = 0; set < sets_; ++set) {
    const auto first = counts_.begin() + static_cast<std::ptrdiff_t>(set * (bins_ + 1));
    std::partial_sum(first, first + static_cast<std::ptrdiff_t>(bins_ + 1), first);
  }
}

std::int64_t CountedRings::photons_in(std::size_t set, std::size_t first, std::size_t last) const {
  const auto* before = counts_.data() + set * (bins_ + 1);
  return before[last] - before[first];
}

double CountedRings::least_bandwidth() const {
  double widest_bin = 0;
  for (const Segment& segment : segments_) widest_bin = std::max(widest_bin, 1 / segment.per_mm2);
  return fewest_bins_per_bandwidth * widest_bin;
}

std::size_t CountedRings::memory_bytes() const { return counts_.size() * sizeof(counts_[0]); }

RingStore::Places CountedRings::places(std::size_t set, double widest) const {
  Places places;
  for (const Segment& segment : segments_) {
    const std::size_t wanted = std::bit_floor(static_cast<std::size_t>(
        std::clamp(widest * segment.per_mm2, 1.0, static_cast<double>(segment.bins))));
    for (std::size_t bin = 0; bin < segment.bins; bin += wanted) {
      // At the photons' own middle: a beam far narrower than the kernel fills a part of one place only.
      double photons = 0, moment = 0;
      for (std::size_t i = 0; i < wanted; ++i) {
        const auto here =
            static_cast<double>(photons_in(set, segment.first + bin + i, segment.first + bin + i + 1));
        photons += here;
        moment += here * (static_cast<double>(i) + 0.5);
      }
      const double middle = photons > 0 ? moment / photons : 0.5 * static_cast<double>(wanted);
      places.squares.push_back(segment.low + (static_cast<double>(bin) + middle) / segment.per_mm2);
      places.photons.push_back(photons);
    }
  }
  return places;
}

RingBins CountedRings::merged(const Segment& segment, double bandwidth) const {
  const double wanted =
      std::min(bins_per_bandwidth * segment.width() / bandwidth, static_cast<double>(segment.bins));
  RingBins merged;
  merged.bins = std::max(fewest_bins, std::bit_ceil(static_cast<std::size_t>(wanted)));
  merged.bins = std::min<std::size_t>(segment.bins, merged.bins);
  merged.bin_width = segment.width() / static_cast<double>(merged.bins);
  merged.row = RingBins::row_of(sets_);
  merged.counts = std::make_unique_for_overwrite<double[]>(merged.bins * merged.row);
  const std::size_t factor = segment.bins / merged.bins;
  for (std::size_t set = sets_; set < merged.row; ++set)
    for (std::size_t bin = 0; bin < merged.bins; ++bin) merged.counts[bin * merged.row + set] = 0;
  for (std::size_t set = 0; set < sets_; ++set)
    for (std::size_t bin = 0; bin < merged.bins; ++bin) {
      const std::size_t first = segment.first + bin * factor;
      merged.counts[bin * merged.row + set] = static_cast<double>(photons_in(set, first, first + factor));
    }
  return merged;
}

template <typename ReadingOf>
void CountedRings::read(std::span<const double> places, RingKernel kernel, double bandwidth,
                        const ReadingOf& reading_of, const TakeDensity& take) const {
  std::vector<std::optional<RingNodes>> nodes(segments_.size());
  const auto reading_at = [&](std::size_t i, double s) {
    return reading_of(*nodes[i], (s - segments_[i].low) / nodes[i]->bin_width());
  };
  for (double s : places) {
    const std::size_t i = segment_of(s);
    if (!nodes[i]) {
      const double own = std::min(bandwidth, segments_[i].width());
      nodes[i].emplace(merged(segments_[i], own), kernel, own);
    }
    nodes[i]->want(reading_at(i, s));
  }
  for (auto& each : nodes)
    if (each) each->estimate();
  constexpr std::size_t chunk = 512;
  side_by_side((places.size() + chunk - 1) / chunk, [&](std::size_t part) {
    RingDensity density;
    for (std::size_t place = part * chunk; place < std::min(places.size(), (part + 1) * chunk); ++place) {
      const std::size_t i = segment_of(places[place]);
      nodes[i]->read(reading_at(i, places[place]), density);
      take(place, density);
    }
  });
}

void CountedRings::estimate(std::span<const double> places, RingKernel kernel, double bandwidth,
                            const TakeDensity& take) const {
  read(
      places, kernel, bandwidth, [](const RingNodes& nodes, double place) { return nodes.between(place); },
      take);
}

void CountedRings::estimate_near(std::span<const double> places, RingKernel kernel, double bandwidth,
                                 const TakeDensity& take) const {
  read(
      places, kernel, bandwidth, [](const RingNodes& nodes, double place) { return nodes.nearest(place); },
      take);
}

}  // namespace catoptric::sim
