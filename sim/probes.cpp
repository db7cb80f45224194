#include "sim/probes.h"

#include <algorithm>
#include <cmath>

#include "base/contract.h"
#include "base/ordered_sum.h"

namespace catoptric::sim {
namespace {

constexpr std::uint32_t cells_across = 32;  ///< squares along each edge of the field
static_assert(cells_across * cells_across == FieldCells::count);

std::uint32_t step_of(double share, std::uint32_t steps) {
  const double step = share * steps;
  return step > 0 ? std::min(static_cast<std::uint32_t>(step), steps - 1) : 0;
}

/// The five bits of a number with gaps of one bit.
std::uint32_t spread_bits(std::uint32_t number) {
  number = (number | (number << 4)) & 0x10f;
  number = (number | (number << 2)) & 0x133;
  return (number | (number << 1)) & 0x155;
}

}  // namespace

FieldCells FieldCells::squares(const NearField& field) {
  FieldCells cells;
  cells.half_width_mm_ = field.half_width_mm();
  cells.half_height_mm_ = field.half_height_mm();
  return cells;
}

FieldCells FieldCells::rings(double reach_mm) {
  FieldCells cells;
  cells.half_width_mm_ = reach_mm;
  return cells;
}

std::uint32_t FieldCells::at(const Vector2& plane_mm) const {
  const std::uint32_t across = step_of(0.5 * (plane_mm.x() / half_width_mm_ + 1), cells_across);
  const std::uint32_t up = step_of(0.5 * (plane_mm.y() / half_height_mm_ + 1), cells_across);
  return spread_bits(across) | (spread_bits(up) << 1);
}

std::uint32_t FieldCells::at(double radius_mm) const {
  const double share = radius_mm / half_width_mm_;
  return step_of(share * share, count);
}

ProbePicker::ProbePicker(std::vector<std::uint32_t> cells)
    : order_(cells.size()), starts_(FieldCells::count + 1, 0) {
  for (const std::uint32_t cell : cells) {
    CATOPTRIC_EXPECTS(cell < FieldCells::count);
    ++starts_[cell + 1];
  }
  for (std::size_t cell = 0; cell < FieldCells::count; ++cell) starts_[cell + 1] += starts_[cell];
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t i = 0; i < cells.size(); ++i) order_[next[cells[i]]++] = i;
}

Probes ProbePicker::pick(std::span<const double> light_by_cell, std::size_t wanted) const {
  CATOPTRIC_EXPECTS(light_by_cell.size() == FieldCells::count && wanted > 0);
  double light = 0;  // on cells that have samples
  const auto samples_of = [&](std::size_t cell) { return starts_[cell + 1] - starts_[cell]; };
  for (std::size_t cell = 0; cell < FieldCells::count; ++cell)
    if (samples_of(cell) > 0) light += light_by_cell[cell];
  const double even =
      (light > 0 ? 0.5 : 1.0) * static_cast<double>(wanted) / static_cast<double>(order_.size());
  const double per_light = light > 0 ? 0.5 * static_cast<double>(wanted) / light : 0.0;
  Probes probes;
  double passed = 0.5;  // a sample is picked where this reaches the next whole number
  for (std::size_t cell = 0; cell < FieldCells::count; ++cell) {
    if (samples_of(cell) == 0) continue;
    const double chance =
        std::min(1.0, even + per_light * light_by_cell[cell] / static_cast<double>(samples_of(cell)));
    for (std::size_t i = starts_[cell]; i < starts_[cell + 1]; ++i) {
      passed += chance;
      if (passed < 1) continue;
      passed -= 1;
      probes.picks.push_back(order_[i]);
      probes.shares.push_back(1 / chance);
    }
  }
  const double sum = ordered_sum(probes.shares);
  for (double& share : probes.shares) share /= sum;
  return probes;
}

}  // namespace catoptric::sim
