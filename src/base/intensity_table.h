#pragma once

#include <cstddef>
#include <vector>

#include "base/light_units.h"

namespace catoptric {

/// Angles of a table that are nearer to each other than this are one.
inline constexpr double least_angle_step_deg = 1e-9;

/// Intensity in type C coordinates: gamma is the angle to the luminaire's first axis (its nadir), C the angle
/// about it. Between the angles it is bilinear in both; beyond the range of gamma it is dark.
class IntensityTable {
 public:
  /// @in    gamma_deg: ascending by 1e-9 at least; 0 to 90, 90 to 180 or 0 to 180, ends included
  ///        c_deg: {0} for one plane that holds for all C; else ascending likewise from 0, below 360: a full
  ///        turn values: plane by plane, gamma_deg.size() each, in `quantity`'s unit; 0 to 1e100
  /// @fails InputError with the number of the first value that breaks a rule
  IntensityTable(LightQuantity quantity, std::vector<double> gamma_deg, std::vector<double> c_deg,
                 std::vector<double> values);

  LightQuantity quantity() const { return quantity_; }
  const std::vector<double>& gamma_deg() const { return gamma_deg_; }
  const std::vector<double>& c_deg() const { return c_deg_; }
  const std::vector<double>& values() const { return values_; }
  bool is_rotational() const { return c_deg_.size() == 1; }
  double value(std::size_t plane, std::size_t gamma) const {
    return values_[plane * gamma_deg_.size() + gamma];
  }

  /// Intensity in a direction.
  /// @in    gamma_deg in [0, 180], c_deg finite, any number of turns
  /// @cost  O(log n)
  double at(double gamma_deg, double c_deg) const;

  /// Flux over the sphere, exact for the bilinear interpolant but for rounding; lm or W.
  double flux() const { return zonal_flux(0, 180); }

  /// Flux between two angles to the axis, exact likewise.
  /// @in    0 <= from_deg <= to_deg <= 180
  double zonal_flux(double from_deg, double to_deg) const;

  /// The greatest intensity; the interpolant has none above it.
  double maximum() const;

  bool operator==(const IntensityTable&) const = default;

 private:
  LightQuantity quantity_;
  std::vector<double> gamma_deg_, c_deg_, values_;
};

}  // namespace catoptric
