#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/ring_kernel.h"

namespace catoptric::sim {

/// What several sets of photons (replicates) say about the density at one place, photons per mm^2 of s = r^2.
struct RingDensities {
  std::vector<double> second_order, fourth_order;  ///< one value a set
  double second_square = 0, fourth_square = 0;  ///< sums of squared weights over all sets (Poisson variance)
};

/// Landing radii squared of several sets of photons, between 0 and an end, cut into segments at the known
/// jumps of the density; no estimate looks across a cut.
class RingStore {
 public:
  /// @in cuts from 0 to the end, rising
  RingStore(std::vector<double> cuts, std::size_t sets) : cuts_(std::move(cuts)), sets_(sets) {}
  virtual ~RingStore() = default;

  /// Safe to call from several threads; values beyond the end are left out.
  virtual void add(std::size_t set, std::uint64_t chunk, std::span<const double> squares) = 0;
  /// Called once after all photons have come.
  virtual void close() = 0;
  /// Called before estimates of another bandwidth.
  virtual void prepare(double bandwidth) = 0;
  /// The least bandwidth that the storage can resolve.
  virtual double least_bandwidth() const = 0;
  virtual std::size_t memory_bytes() const = 0;

  /// @in    s in [0, end]; the bandwidth last prepared for
  /// @error bias of second and fourth order in the bandwidth, on cuts and near them too, where the density is
  ///        smooth between cuts; counted photons add bin^2 / 24 times its second derivative
  virtual void estimate(double s, RingKernel kernel, double bandwidth, RingDensities& out) const = 0;

  /// The photons of one set as rings: places in s and how many photons stand there.
  /// @in    widest: of the range in s that one place may stand for
  struct Places {
    std::vector<double> squares, photons;
  };
  virtual Places places(std::size_t set, double widest) const = 0;

  double end() const { return cuts_.back(); }
  std::size_t sets() const { return sets_; }

 protected:
  struct Window {
    std::size_t segment;
    double bandwidth;  ///< no wider than the segment
    double low, high;  ///< of the segment
  };
  Window window(double s, double bandwidth) const;
  std::vector<double> cuts_;
  std::size_t sets_;
};

/// Every photon kept, in order.
class SortedRings final : public RingStore {
 public:
  SortedRings(std::vector<double> cuts, std::size_t sets, std::span<const std::uint64_t> chunks);
  void add(std::size_t set, std::uint64_t chunk, std::span<const double> squares) override;
  void close() override;
  void prepare(double) override {}
  double least_bandwidth() const override;
  std::size_t memory_bytes() const override;
  void estimate(double s, RingKernel kernel, double bandwidth, RingDensities& out) const override;
  Places places(std::size_t set, double widest) const override;

 private:
  std::vector<std::vector<std::vector<double>>> parts_;  ///< by set and chunk
  std::vector<std::vector<double>> squares_;             ///< by set, rising
};

/// Photons counted in even bins of each segment: memory does not grow with the photons, and whole numbers
/// make the counts the same in any order.
class CountedRings final : public RingStore {
 public:
  CountedRings(std::vector<double> cuts, std::size_t sets, std::size_t bins);
  void add(std::size_t set, std::uint64_t chunk, std::span<const double> squares) override;
  void close() override {}
  void prepare(double bandwidth) override;
  double least_bandwidth() const override;
  std::size_t memory_bytes() const override;
  void estimate(double s, RingKernel kernel, double bandwidth, RingDensities& out) const override;
  Places places(std::size_t set, double widest) const override;

 private:
  struct Segment {
    double low, width, per_mm2;             ///< of the segment; bins per mm^2
    std::size_t bins, first;                ///< first bin among all
    std::size_t merged_bins, merged_first;  ///< the same after merging for the present bandwidth
  };
  std::vector<Segment> segments_;
  std::size_t bins_ = 0;
  std::vector<std::atomic<std::uint64_t>> counts_;  ///< by set, then bin
  std::size_t merged_bins_ = 0;
  std::vector<double> merged_;  ///< by set, then merged bin; one more row holds the sum over the sets
};

}  // namespace catoptric::sim
