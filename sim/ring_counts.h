#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "sim/ring_nodes.h"
#include "sim/ring_store.h"

namespace catoptric::sim {

/// Photons counted in even bins of each segment: memory does not grow with the photons, and whole numbers
/// make the counts the same in any order.
class CountedRings final : public RingStore {
 public:
  CountedRings(std::vector<double> cuts, std::size_t sets, std::size_t bins);
  void add(std::size_t set, std::uint64_t chunk, std::span<const double> squares) override;
  void close() override;
  double least_bandwidth() const override;
  std::size_t memory_bytes() const override;
  /// @cost  a window of 32 to 64 bins for each of 16 to 32 nodes a bandwidth, some 40 ns each, and 40 ns a
  ///        place that reads four of them
  void estimate(std::span<const double> places, RingKernel kernel, double bandwidth,
                const TakeDensity& take) const override;
  void estimate_near(std::span<const double> places, RingKernel kernel, double bandwidth,
                     const TakeDensity& take) const override;
  Places places(std::size_t set, double widest) const override;

 private:
  struct Segment {
    double low, high, per_mm2;  ///< of the segment; bins per mm^2
    std::uint32_t bins, first;  ///< first bin among all
    double width() const { return high - low; }
  };
  template <typename ReadingOf>
  void read(std::span<const double> places, RingKernel kernel, double bandwidth, const ReadingOf& reading_of,
            const TakeDensity& take) const;
  RingBins merged(const Segment& segment, double bandwidth) const;
  /// Photons of a set in bins [first, last) of all; after close().
  std::int64_t photons_in(std::size_t set, std::size_t first, std::size_t last) const;

  std::vector<Segment> segments_;
  std::uint32_t bins_ = 0;
  std::mutex mutex_;  ///< of the counts while photons come: held for 1 of the 35 us that a chunk flies
  /// By set, then bin: photons in the bin before, after close() in all before.
  std::vector<std::int64_t> counts_;
};

}  // namespace catoptric::sim
