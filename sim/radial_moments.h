#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/stored_photons.h"

namespace catoptric::sim {

/// Silverman-kernel weights about a point for a whole ladder of radii at once, each narrower than the one
/// before by the root of two. The kernel is a polynomial in the squared distance, so that number, sum and sum
/// of squares of the squared distances, by halvings of the square, give its weight under every radius. Which
/// halving a photon belongs to is the binary exponent of its squared distance.
class RadialMoments {
 public:
  /// @in a positive radius, at least one level
  RadialMoments(double widest_radius_mm, std::size_t levels);

  /// Forgets all photons and moves to another point.
  void start(const StoredPhoton& centre);

  /// Adds the photons (x[i], y[i]) that lie within the widest radius.
  void add(const double* x_mm, const double* y_mm, std::size_t count);

  double radius_mm(std::size_t level) const;

  /// By level what KernelSum::weight is with the level's radius.
  /// @error some roundings of the number of photons within that radius
  void weights(std::span<double> by_level) const;

 private:
  /// Of t = squared distance over the widest radius' square.
  struct Moments {
    double count = 0, sum = 0, squares = 0;
  };
  /// Two that take turns: a photon's sum need not wait for the one before.
  static constexpr std::size_t turns = 2;

  double radius_mm_, per_mm2_;
  std::size_t levels_;
  StoredPhoton centre_{};
  std::vector<Moments> rings_;  ///< [halving][turn]; halving 0 is beyond the widest radius
};

}  // namespace catoptric::sim
