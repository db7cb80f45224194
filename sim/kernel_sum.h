#pragma once

#include <array>
#include <cstddef>

#include "sim/kernel.h"

namespace catoptric::sim {

/// Kernel weights summed over photons, several photons at a time. Photon i of a stretch goes to partial sum
/// i modulo their number, and the partial sums are joined in order: the result depends on the stretches
/// alone, not on how many photons the processor takes at once.
class KernelSum {
 public:
  static constexpr std::size_t lanes = 8;
  /// Partial sums, by photon number modulo `lanes`.
  struct Sums {
    std::array<double, lanes> weight{}, weight_squared{}, photons{};
  };

  /// The kernel about (x, y), of this radius.
  KernelSum(Kernel kernel, double x_mm, double y_mm, double radius_mm)
      : kernel_(kernel), x_mm_(x_mm), y_mm_(y_mm), square_mm2_(radius_mm * radius_mm) {}

  /// Adds the photons (x[i], y[i]) that lie within the radius.
  void add(const double* x_mm, const double* y_mm, std::size_t count);

  /// Adds photons that all lie within the radius, given by the squares of their distances.
  void add_squares(const double* squares_mm2, std::size_t count);

  double weight() const { return joined(sums_.weight); }
  double weight_squared() const { return joined(sums_.weight_squared); }
  std::size_t photons() const;

 private:
  static double joined(const std::array<double, lanes>& parts);

  Kernel kernel_;
  double x_mm_, y_mm_, square_mm2_;
  Sums sums_;
};

}  // namespace catoptric::sim
