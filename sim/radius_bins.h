#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace catoptric::sim {

/// Errors booked over the ranges of radii they can reach; the field's error is the worst bin's sum.
class RadiusBins {
 public:
  explicit RadiusBins(double r_max_mm) : bins_per_mm_(static_cast<double>(count) / r_max_mm) {}

  /// Ranges that lie beyond the largest radius or below 0 count nowhere.
  void add(double first_mm, double last_mm, double error) {
    if (!(last_mm >= 0 && first_mm * bins_per_mm_ <= static_cast<double>(count))) return;
    for (std::size_t i = bin_of(first_mm); i <= bin_of(last_mm); ++i) error_[i] += error;
  }
  void add_everywhere(double error) {
    for (double& each : error_) each += error;
  }
  double worst() const { return *std::max_element(error_.begin(), error_.end()); }
  void clear() { error_.fill(0); }

 private:
  static constexpr std::size_t count = 64;
  std::size_t bin_of(double r_mm) const {
    return static_cast<std::size_t>(std::clamp(r_mm * bins_per_mm_, 0.0, static_cast<double>(count - 1)));
  }
  double bins_per_mm_;
  std::array<double, count> error_{};
};

}  // namespace catoptric::sim
