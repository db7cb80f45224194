#include "sim/photon_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/contract.h"
#include "base/tolerance.h"

namespace catoptric::sim {
namespace {

/// Photons of a cell when they lie evenly: fewer would make more and shorter stretches of a circle's rows,
/// more would let it look at more photons outside it.
constexpr double photons_of_a_cell = 8;

}  // namespace

std::size_t PhotonGrid::Axis::cell_of(double at) const {
  // Rising in `at`, rounding or not: a point between two others has a cell between theirs.
  const double cell = (at - first) * per_mm;
  if (!(cell > 0)) return 0;
  return cell < static_cast<double>(cells) ? static_cast<std::size_t>(cell)
                                           : cells - 1;  // it may be infinite
}

PhotonGrid::Axis PhotonGrid::axis_over(double low, double high, double cell_mm) {
  Axis axis;
  axis.first = low;
  const double width = high - low;
  if (!(width > 0 && cell_mm > 0)) return axis;
  axis.cells = static_cast<std::size_t>(std::max(1.0, std::ceil(width / cell_mm)));
  axis.cell_mm = width / static_cast<double>(axis.cells);
  constexpr double least = std::numeric_limits<double>::min();  // below, an inverse may overflow
  if (!(axis.cell_mm > least)) return {low, 1, 0, 1};
  axis.per_mm = 1 / axis.cell_mm;
  return axis;
}

PhotonGrid::PhotonGrid(std::vector<std::vector<StoredPhoton>*> stretches) {
  for (const auto* stretch : stretches) size_ += stretch->size();
  CATOPTRIC_EXPECTS(size_ < std::uint64_t{1} << 32);
  if (size_ == 0) return;
  measure(stretches);
  sort(stretches);
}

void PhotonGrid::measure(const std::vector<std::vector<StoredPhoton>*>& stretches) {
  double left = HUGE_VAL, right = -HUGE_VAL, bottom = HUGE_VAL, top = -HUGE_VAL;
  for (const auto* stretch : stretches)
    for (const StoredPhoton& photon : *stretch) {
      left = std::min(left, photon.x_mm);
      right = std::max(right, photon.x_mm);
      bottom = std::min(bottom, photon.y_mm);
      top = std::max(top, photon.y_mm);
    }
  const double width = right - left, height = top - bottom;
  const double cells = std::max(1.0, static_cast<double>(size_) / photons_of_a_cell);
  // Square cells, but never more of them along a side than there are in all.
  const double cell = std::max(std::sqrt(width / cells * height), std::max(width, height) / cells);
  across_ = axis_over(left, right, cell);
  up_ = axis_over(bottom, top, cell);
  right_ = right;
  top_ = top;
  const double size = std::max({std::abs(left), std::abs(right), std::abs(bottom), std::abs(top)});
  slack_mm_ = size > 0 ? Tolerance::for_scale(size).length_mm : 0;
}

void PhotonGrid::sort(std::vector<std::vector<StoredPhoton>*>& stretches) {
  const auto cell_of = [this](const StoredPhoton& photon) {
    return up_.cell_of(photon.y_mm) * across_.cells + across_.cell_of(photon.x_mm);
  };
  // Counts stand two places on: summed up, the place before a cell's own is where its next photon goes, and
  // once all have gone, the cell's own is where it starts.
  starts_.assign(across_.cells * up_.cells + 2, 0);
  for (const auto* stretch : stretches)
    for (const StoredPhoton& photon : *stretch) ++starts_[cell_of(photon) + 2];
  for (std::size_t i = 2; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  x_.resize(size_);
  y_.resize(size_);
  for (auto* stretch : stretches) {
    for (const StoredPhoton& photon : *stretch) {
      const std::uint32_t place = starts_[cell_of(photon) + 1]++;
      x_[place] = photon.x_mm;
      y_[place] = photon.y_mm;
    }
    std::vector<StoredPhoton>().swap(*stretch);  // assigning {} would keep its memory
  }
  starts_.pop_back();
}

PhotonGrid::Row PhotonGrid::row_from(double y_mm, std::size_t row) const {
  const double low = up_.first + static_cast<double>(row) * up_.cell_mm - y_mm, high = low + up_.cell_mm;
  return {std::max({0.0, low - slack_mm_, -high - slack_mm_}),
          std::max(std::abs(low), std::abs(high)) + slack_mm_};
}

template <typename Take>
void PhotonGrid::for_each_stretch(const StoredPhoton& centre, double radius_mm, const Take& take) const {
  const double x = centre.x_mm, y = centre.y_mm;
  // What the subtraction from x rounds away must not leave a photon out.
  const double reach = radius_mm + slack_mm_;
  if (size_ == 0 ||
      !(y + reach >= up_.first && y - reach <= top_ && x + reach >= across_.first && x - reach <= right_))
    return;
  const std::size_t last_row = up_.cell_of(y + reach);
  for (std::size_t row = up_.cell_of(y - reach); row <= last_row; ++row) {
    const double nearest = row_from(y, row).nearest_mm;
    const double half_square = (reach - nearest) * (reach + nearest);
    if (!(half_square >= 0)) continue;
    const double half = std::sqrt(half_square) + slack_mm_;
    const std::size_t base = row * across_.cells;
    const std::size_t first = starts_[base + across_.cell_of(x - half)];
    const std::size_t last = starts_[base + across_.cell_of(x + half) + 1];
    if (last > first) take(first, last - first);
  }
}

void PhotonGrid::add_within(const StoredPhoton& centre, double radius_mm, KernelSum& sum) const {
  for_each_stretch(centre, radius_mm, [&](std::size_t first, std::size_t count) {
    sum.add(x_.data() + first, y_.data() + first, count);
  });
}

void PhotonGrid::add_within(const StoredPhoton& centre, double widest_radius_mm, LadderSum& sum) const {
  for_each_stretch(centre, widest_radius_mm, [&](std::size_t first, std::size_t count) {
    sum.add(x_.data() + first, y_.data() + first, count);
  });
}

void PhotonGrid::append_squares(const StoredPhoton& centre, double radius_mm,
                                std::vector<double>& squares_mm2) const {
  const double square = radius_mm * radius_mm;
  for_each_stretch(centre, radius_mm, [&](std::size_t first, std::size_t count) {
    std::size_t end = squares_mm2.size();
    squares_mm2.resize(end + count);
    for (std::size_t i = first; i < first + count; ++i) {
      const double dx = x_[i] - centre.x_mm, dy = y_[i] - centre.y_mm;
      const double each = dx * dx + dy * dy;
      squares_mm2[end] = each;
      end += each <= square;
    }
    squares_mm2.resize(end);
  });
}

std::size_t PhotonGrid::surely_within(const StoredPhoton& centre, double radius_mm) const {
  const double x = centre.x_mm, y = centre.y_mm;
  if (size_ == 0 || !(y + radius_mm >= up_.first && y - radius_mm <= top_)) return 0;
  std::size_t count = 0;
  const std::size_t last_row = up_.cell_of(y + radius_mm);
  for (std::size_t row = up_.cell_of(y - radius_mm); row <= last_row; ++row) {
    const double farthest = row_from(y, row).farthest_mm;
    const double half_square = (radius_mm - farthest) * (radius_mm + farthest);
    if (!(half_square > 0)) continue;
    const double half = std::sqrt(half_square) - slack_mm_;
    // Cells beyond the one that holds the border lie wholly inside it; at the grid's sides there is none.
    const std::size_t first = x - half < across_.first ? 0 : across_.cell_of(x - half) + 1;
    const std::size_t end = x + half > right_ ? across_.cells : across_.cell_of(x + half);
    if (!(half > 0) || end <= first) continue;
    const std::size_t base = row * across_.cells;
    count += starts_[base + end] - starts_[base + first];
  }
  return count;
}

}  // namespace catoptric::sim
