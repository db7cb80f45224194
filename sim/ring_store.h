#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sim/ring_kernel.h"

namespace catoptric::sim {

/// What several sets of photons (replicates) say about the density at one place, photons per mm^2 of s = r^2.
struct RingDensity {
  std::vector<double> second_order, fourth_order;  ///< one value a set; more are zeros
  double second_square = 0, fourth_square = 0;  ///< sums of squared weights over all sets (Poisson variance)
};

/// Takes the density at the place of that index; called for every place once, from several threads and in any
/// order. What is handed over lasts as long as the call.
using TakeDensity = std::function<void(std::size_t place, const RingDensity&)>;

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
  /// The least bandwidth that the storage can resolve.
  virtual double least_bandwidth() const = 0;
  virtual std::size_t memory_bytes() const = 0;

  /// @in    places in [0, end], in any order
  /// @out   the same at a place whatever others are asked for, and for any number of threads
  /// @error bias of second and fourth order in the bandwidth, on cuts and near them too, where the density is
  ///        smooth between cuts; counted photons add bin^2 / 24 times its second derivative
  virtual void estimate(std::span<const double> places, RingKernel kernel, double bandwidth,
                        const TakeDensity& take) const = 0;
  /// The same at places nearby, no farther than a sixteenth of the bandwidth (or half a bin of what the
  /// storage resolves), where an estimate costs least.
  virtual void estimate_near(std::span<const double> places, RingKernel kernel, double bandwidth,
                             const TakeDensity& take) const {
    estimate(places, kernel, bandwidth, take);
  }

  /// The photons of one set as rings: places in s and how many photons stand there.
  /// @in    widest: of the range in s that one place may stand for
  struct Places {
    std::vector<double> squares, photons;
  };
  virtual Places places(std::size_t set, double widest) const = 0;

  double end() const { return cuts_.back(); }
  std::size_t sets() const { return sets_; }

 protected:
  /// Of the segment that s lies in; on a cut, the one above it.
  std::size_t segment_of(double s) const;
  std::vector<double> cuts_;
  std::size_t sets_;
};

/// Every photon kept, in order.
class SortedRings final : public RingStore {
 public:
  SortedRings(std::vector<double> cuts, std::size_t sets, std::span<const std::uint64_t> chunks);
  void add(std::size_t set, std::uint64_t chunk, std::span<const double> squares) override;
  void close() override;
  double least_bandwidth() const override;
  std::size_t memory_bytes() const override;
  void estimate(std::span<const double> places, RingKernel kernel, double bandwidth,
                const TakeDensity& take) const override;
  Places places(std::size_t set, double widest) const override;

 private:
  void look(double s, RingKernel kernel, double bandwidth, RingDensity& out) const;
  std::vector<std::vector<std::vector<double>>> parts_;  ///< by set and chunk
  std::vector<std::vector<double>> squares_;             ///< by set, rising
};

}  // namespace catoptric::sim
