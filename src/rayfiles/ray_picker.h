#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rayfiles/ray_set.h"

namespace catoptric::rayfiles {

/// A ray, and what is left of the number that picked it.
struct PickedRay {
  std::uint64_t ray;
  double rest;  ///< in [0, 1), even over the numbers that pick this ray
};

/// Picks rays with probability in proportion to their flux, by inversion of the sum of fluxes: photons that
/// all carry the same power then have the light of the source. Greater numbers never pick earlier rays, nor a
/// smaller rest of the same ray, so that evenly spread numbers (Sobol points) pick evenly. Rays without flux
/// are never picked.
///
/// The table holds the sum before every 64th ray: 125 MB for 1e9 rays; none when all rays have the same flux.
/// Safe to use from many threads.
class RayPicker {
 public:
  /// @fails InputError for a flux that is negative or not finite, no flux at all, or a file that has changed
  /// @cost  one pass over the fluxes, two where they differ late
  explicit RayPicker(std::shared_ptr<const RaySet> rays);

  /// @in    u in [0, 1)
  /// @error a share is right to some 1e-16 of the total flux; the rest has as many bits as u has left
  /// @cost  O(log n) in the table, then at most 64 fluxes from the file; O(1) when all are the same
  PickedRay pick(double u) const;

  /// Sum of all fluxes, W or lm.
  double total_flux() const { return total_; }

  /// Memory that the table takes.
  std::uint64_t table_bytes() const { return sums_.size() * sizeof(double); }

 private:
  double sound_flux(std::uint64_t i) const;
  bool all_equal() const;
  void build_table();
  PickedRay pick_in_block(std::uint64_t block, double rest_flux) const;

  static constexpr std::uint64_t block_size = 64;
  std::shared_ptr<const RaySet> rays_;
  std::vector<double> sums_;  ///< of the fluxes before each block, and of all
  double total_ = 0;
};

}  // namespace catoptric::rayfiles
