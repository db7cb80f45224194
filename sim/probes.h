#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/near_field.h"

namespace catoptric::sim {

/// Cells of the near field, numbered so that cells of neighbouring numbers lie side by side. Photons and
/// samples are told apart by cell.
class FieldCells {
 public:
  /// Squares of a grid, along Morton's curve.
  static FieldCells squares(const NearField& field);
  /// Rings about the axis, of equal area.
  /// @in greatest distance from the axis that cells reach, mm
  static FieldCells rings(double reach_mm);

  static constexpr std::size_t count = 1024;

  double reach_mm() const { return half_width_mm_; }  ///< of rings
  std::uint32_t at(const Vector2& plane_mm) const;    ///< of squares; what lies outside counts to the border
  std::uint32_t at(double radius_mm) const;           ///< of rings

 private:
  double half_width_mm_ = 1, half_height_mm_ = 1;
};

/// Some samples that stand for all of them.
struct Probes {
  std::vector<std::size_t> picks;  ///< indices of samples, each once
  std::vector<double> shares;      ///< of all samples that each stands for; their sum is 1
};

/// Picks some of a list of samples, so that sums over the samples can be told from few: half of them evenly,
/// half where light falls, so that a spot that holds all the light is not missed however small it is.
class ProbePicker {
 public:
  /// @in the cell of each sample, below FieldCells::count
  explicit ProbePicker(std::vector<std::uint32_t> cells);

  /// Systematic sampling with probability proportional to size along the cells.
  /// @in    how much light falls on each cell, in any unit; about so many picks
  /// @out   weighted sums over the picks estimate those over all samples without bias, whatever the light
  /// @cost  O(samples)
  /// @from  Madow 1949; Hajek 1971 for the normalised shares
  Probes pick(std::span<const double> light_by_cell, std::size_t wanted) const;

 private:
  std::vector<std::size_t> order_;   ///< samples by cell
  std::vector<std::size_t> starts_;  ///< of each cell in `order_`, and their number
};

}  // namespace catoptric::sim
