#pragma once

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

/// Sets of photons seen through a ladder of bandwidths, each narrower than the one before by the root of two.
struct BandwidthLadder {
  std::vector<LadderLevel> levels;  ///< widest first
  EnergyLedger energy;              ///< mean of the sets
  PhotonCounts counts;              ///< of all sets together
};

struct LadderOptions {
  Rung rung = Rung::photons;  ///< rings or photons
  PhotonOptions photons;      ///< of one set; set i flies on stream + i
  std::size_t sets = 4;
  double widest_radius_mm = 0;
  std::size_t levels = 1;
};

/// The widest kernel that a field can be looked at with: half of its smaller half width. Beyond it no
/// estimate is local.
double widest_kernel_radius_mm(const NearField& field);

/// Lets the sets fly one after the other, so that only one is in memory, and looks at each with every
/// bandwidth.
/// @in    samples on the near field; the rung valid for the scene
/// @out   the same bits for any number of threads
/// @fails as trace_photons or RingPhotons
/// @error fourth order of rung photons: twice the estimate of half the kernel area less the estimate
///        (Richardson extrapolation, Schucany & Sommers 1977); of rings: boundary kernels of fourth order
/// @cost  that of sets * photons and sets * levels * samples estimates
BandwidthLadder look_with_ladder(const Scene& scene, std::span<const FieldSample> samples,
                                 const LadderOptions& options);

}  // namespace catoptric::sim
