#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/planner.h"
#include "sim/scene.h"
#include "sim/tracer.h"

namespace catoptric::sim {

/// Fields of several independent sets of photons: [set][sample], W/mm^2, reflected light.
using SetFields = std::vector<std::vector<double>>;

/// The same sets seen with one bandwidth.
struct LadderLevel {
  double kernel_radius_mm = 0;  ///< rings: of the disc with the area of the ring that an estimate looks at
  double independent = 1;       ///< how many kernels side by side cover the field: what varies independently
  SetFields second;             ///< bias of second order in the radius
  SetFields fourth;             ///< of fourth order: the blur of second order extrapolated away
};

/// Sets of photons seen through a ladder of bandwidths, each narrower than the one before by the root of two;
/// widest first.
using BandwidthLadder = std::vector<LadderLevel>;

/// How many of so many photons of rung photons, all sets together, one of so many ranks keeps at most.
std::uint64_t most_kept_by_a_rank(std::uint64_t photons, int ranks);

/// The widest kernel that a field can be looked at with: half of its smaller half width. Beyond it no
/// estimate is local.
double widest_kernel_radius_mm(const NearField& field);

/// Sets that a proof of accuracy takes: fewer give no spread, more waste the points' evenness.
inline constexpr std::uint64_t sets_of_photons = 4;

/// Independent sets of photons of one size, kept so that they can be looked at with any bandwidth. What all
/// sets share, and all sizes, is prepared once. Several ranks keep a part of the photons each, and all come
/// to the same calls.
class PhotonSets {
 public:
  /// @in    rung rings or photons, valid for the scene; the scene must outlive this
  /// @fails InputError for a bad mirror material
  PhotonSets(const Scene& scene, Rung rung);
  ~PhotonSets();

  /// Lets the sets fly, in place of those before: set i on stream + i.
  /// @in    photons of one set; the widest radius that will be looked at
  /// @out   the same bits for any number of threads and ranks
  /// @fails as trace_photons or RingPhotons
  /// @cost  all sets are in memory: 17 bytes a photon, for rings 8 bytes a bin. options.ranks share them: by
  ///        sets of rings, by sets and slices of 2^20 photons or more, 64 a set at most, of rung photons
  void fly(const PhotonOptions& options, std::size_t sets, double widest_radius_mm);

  /// @in    samples on the near field; radii down to widest_radius_mm / sqrt(2)^levels
  /// @out   as many levels as asked for, or fewer, two at least, where storage does not resolve narrower ones
  /// @error fourth order of rung photons: twice the estimate of half the kernel area less the estimate
  ///        (Richardson extrapolation, Schucany & Sommers 1977); of rings: boundary kernels of fourth order
  /// @cost  of photons one gathering a sample and set, of rings one estimate a level, sample and set
  BandwidthLadder look(std::span<const FieldSample> samples, double widest_radius_mm,
                       std::size_t levels) const;

  /// Which cells samples lie in, and how much light falls on each, W to a common factor, as far as some
  /// thousand photons tell.
  std::vector<std::uint32_t> cells_of(std::span<const FieldSample> samples) const;
  const std::vector<double>& light_by_cell() const;

  /// One reading at other samples: as look() gives it, to rounding.
  /// @in   order 2 or 4
  /// @cost of photons one sum of weights a sample and set, two for order 4
  SetFields fields(std::span<const FieldSample> samples, double kernel_radius_mm, int order) const;

  const EnergyLedger& energy() const;  ///< mean of the sets
  const PhotonCounts& counts() const;  ///< of all sets together

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace catoptric::sim
