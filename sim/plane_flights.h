#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "sim/tracer.h"

namespace catoptric::sim {

/// Photons that never leave their meridian plane, traced in that plane: half the degree of the equations, and
/// of the emission's numbers only the first counts. With the sampler "random", photon i has the fate it has
/// in PhotonFlights, roulette included; with "sobol" the first numbers are stratified one by one.
class PlaneFlights {
 public:
  /// Whether photons stay in their planes and the field's edge is a circle about the axis: a point source on
  /// the axis, a plane disc about it without diffuse reflection, and the engine that agrees with the plane
  /// one to rounding, "meridian".
  static bool possible(const Scene& scene);

  /// Records crossings of the field's plane out to `reach_mm` from the axis (a real disc: to its edge).
  /// @in    what the scene borrows must outlive this
  /// @fails InputError for a bad mirror material
  PlaneFlights(const Scene& scene, double reach_mm);
  ~PlaneFlights();

  /// Takes the squared radii of one chunk's crossings on the side asked for; from several threads.
  using TakeSquares = std::function<void(std::uint64_t chunk, const std::vector<double>& squares)>;

  /// @in    front: the crossings against the field's normal, else those along it
  /// @fails InputError for more than most_photons photons, most_interactions below 1
  /// @cost  some 0.03 us a photon where most are reflected once, 0.1 us a bounce of the others
  FlightTotals fly(const PhotonOptions& options, bool front, const TakeSquares& take) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace catoptric::sim
