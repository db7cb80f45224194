#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/stored_photons.h"

namespace catoptric::sim {

/// Silverman-kernel weights about a point for a whole ladder of radii at once, each narrower than the one
/// before by the root of two. Photons are held back until some hundred have come and are then weighed by
/// vectors, a few levels at a time; those near enough for narrower levels pass on to them.
class LadderSum {
 public:
  /// @in a positive radius, at least one level
  LadderSum(double widest_radius_mm, std::size_t levels);

  /// Forgets all photons and moves to another point.
  void start(const StoredPhoton& centre);

  /// Adds the photons (x[i], y[i]) that lie within the widest radius.
  void add(const double* x_mm, const double* y_mm, std::size_t count);

  /// By level what KernelSum::weight is with the level's radius; the same bits however many lanes the
  /// processor has.
  /// @error some roundings of the number of photons within that radius
  void weights(std::span<double> by_level);

  static constexpr std::size_t lanes = 8;
  static constexpr std::size_t held = 256;       ///< photons weighed at a time
  static constexpr std::size_t tier_levels = 4;  ///< a sixteenth of evenly spread photons passes on

  /// Some levels, and photons near enough for them that are still to be weighed: their squared distances
  /// over the square of the widest radius of all.
  struct Tier {
    double narrowing = 1;  ///< square of the widest radius of all over the tier's widest
    std::size_t levels = 0, count = 0;
    std::array<double, held + lanes> squares;  ///< with room for whole lanes
    std::array<std::array<double, lanes>, tier_levels> sums;
  };

 private:
  void weigh(std::size_t tier);

  double per_mm2_;
  StoredPhoton centre_{};
  std::vector<Tier> tiers_;
};

}  // namespace catoptric::sim
