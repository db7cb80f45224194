#include "report/field_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "base/errors.h"

namespace catoptric::report {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Extent {
  double least, greatest;
  double size() const { return greatest - least; }
};

Extent extent_of(const std::vector<double>& values) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return {*least, *greatest};
}

/// Samples sorted into square bins, so that a cell looks at its neighbourhood only.
class Bins {
 public:
  Bins(const ScatteredField& field, Extent x, Extent y, double width)
      : field_(field), x_(x), y_(y), width_(width), columns_(count(x)), rows_(count(y)) {
    members_.resize(columns_ * rows_);
    for (std::size_t i = 0; i < field.x.size(); ++i)
      members_[index(field.y[i], y_, rows_) * columns_ + index(field.x[i], x_, columns_)].push_back(i);
  }

  /// Weighted by ((R - d) / (R d))^2 over the samples nearer than R, the width of a bin.
  double value_at(double x, double y) const {
    double sum = 0, weights = 0;
    const std::size_t column = index(x, x_, columns_), row = index(y, y_, rows_);
    for (std::size_t j = row ? row - 1 : 0; j < std::min(row + 2, rows_); ++j)
      for (std::size_t i = column ? column - 1 : 0; i < std::min(column + 2, columns_); ++i)
        for (std::size_t sample : members_[j * columns_ + i]) {
          const double distance = std::hypot(field_.x[sample] - x, field_.y[sample] - y);
          if (distance >= width_) continue;
          if (distance == 0) return field_.value[sample];
          const double weight = std::pow((width_ - distance) / (width_ * distance), 2);
          sum += weight * field_.value[sample];
          weights += weight;
        }
    return weights > 0 ? sum / weights : none;
  }

 private:
  std::size_t count(Extent extent) const { return static_cast<std::size_t>(extent.size() / width_) + 1; }
  std::size_t index(double value, Extent extent, std::size_t bins) const {
    const double place = std::clamp((value - extent.least) / width_, 0.0, static_cast<double>(bins - 1));
    return static_cast<std::size_t>(place);
  }

  const ScatteredField& field_;
  Extent x_, y_;
  double width_;
  std::size_t columns_, rows_;
  std::vector<std::vector<std::size_t>> members_;
};

ScatteredField finite_samples(const ScatteredField& field) {
  if (field.x.size() != field.y.size() || field.x.size() != field.value.size())
    throw InputError(
        {"the field cannot be drawn", "",
         fmt::format("{} x, {} y and {} values", field.x.size(), field.y.size(), field.value.size()),
         "as many of each"});
  ScatteredField finite;
  for (std::size_t i = 0; i < field.x.size(); ++i)
    if (std::isfinite(field.x[i]) && std::isfinite(field.y[i]) && std::isfinite(field.value[i])) {
      finite.x.push_back(field.x[i]);
      finite.y.push_back(field.y[i]);
      finite.value.push_back(field.value[i]);
    }
  if (finite.x.empty())
    throw InputError({"the field cannot be drawn", "", "it has no finite sample", "at least one sample"});
  return finite;
}

/// Distance of neighbours if the samples were spread evenly; some length even when they are all one point.
double sample_distance(std::size_t samples, Extent x, Extent y, std::optional<double> disc_radius) {
  const double n = static_cast<double>(samples);
  const double area = disc_radius ? std::numbers::pi * *disc_radius * *disc_radius : x.size() * y.size();
  if (area > 0) return std::sqrt(area / n);
  const double length = std::max(x.size(), y.size());
  return length > 0 ? length / n : 1;
}

std::vector<double> cell_centres(Extent extent, double width) {
  const auto cells = std::max(2L, std::lround(extent.size() / width));
  std::vector<double> centres;
  for (long i = 0; i < cells; ++i)
    centres.push_back(extent.least +
                      (static_cast<double>(i) + 0.5) * extent.size() / static_cast<double>(cells));
  return centres;
}

/// Index i and share s with value = (1 - s) axis[i] + s axis[i + 1], clamped to the axis.
std::pair<std::size_t, double> place_on(const std::vector<double>& axis, double value) {
  const auto above = std::upper_bound(axis.begin() + 1, axis.end() - 1, value);
  const auto i = static_cast<std::size_t>(above - axis.begin()) - 1;
  return {i, std::clamp((value - axis[i]) / (axis[i + 1] - axis[i]), 0.0, 1.0)};
}

/// a (1 - s) + b s, where an empty neighbour with no share does no harm.
double mixed(double a, double b, double s) { return s == 0 ? a : s == 1 ? b : a * (1 - s) + b * s; }

}  // namespace

void require_sound(const GridField& field) {
  const auto refuse = [](std::string why) {
    throw InputError(
        {"the grid cannot be drawn", "", std::move(why), "at least 2 by 2 values on rising axes"});
  };
  if (field.x.size() < 2 || field.y.size() < 2) refuse("an axis has fewer than two places");
  if (field.value.size() != field.x.size() * field.y.size())
    refuse(fmt::format("{} values for {} by {} places", field.value.size(), field.x.size(), field.y.size()));
  for (const auto* axis : {&field.x, &field.y})
    if (!std::all_of(axis->begin(), axis->end(), [](double v) { return std::isfinite(v); }) ||
        std::adjacent_find(axis->begin(), axis->end(), std::greater_equal<>()) != axis->end())
      refuse("an axis does not rise");
}

GridField gridded(const ScatteredField& field, int cells, std::optional<double> disc_radius) {
  const ScatteredField samples = finite_samples(field);
  Extent x = extent_of(samples.x), y = extent_of(samples.y);
  const double distance = sample_distance(samples.x.size(), x, y, disc_radius);
  for (Extent* extent : {&x, &y})
    *extent = disc_radius ? Extent{-*disc_radius, *disc_radius}
                          : Extent{extent->least - distance / 2, extent->greatest + distance / 2};
  const Bins bins(samples, x, y, 2 * distance);
  const double width = std::max(x.size(), y.size()) / std::max(cells, 2);
  GridField grid{cell_centres(x, width), cell_centres(y, width), {}};
  for (double row : grid.y)
    for (double column : grid.x) {
      const bool inside = !disc_radius || std::hypot(column, row) <= *disc_radius + width;
      grid.value.push_back(inside ? bins.value_at(column, row) : none);
    }
  return grid;
}

GridField refined(const GridField& field, int cells) {
  GridField fine;
  const auto axis = [cells](const std::vector<double>& coarse) {
    std::vector<double> places;
    for (int i = 0; i <= cells; ++i)
      places.push_back(coarse.front() + (coarse.back() - coarse.front()) * i / cells);
    return places;
  };
  fine.x = axis(field.x);
  fine.y = axis(field.y);
  for (double y : fine.y)
    for (double x : fine.x) fine.value.push_back(interpolated(field, x, y));
  return fine;
}

double interpolated(const GridField& field, double x, double y) {
  const auto [i, s] = place_on(field.x, x);
  const auto [j, t] = place_on(field.y, y);
  const double value = mixed(mixed(field.at(i, j), field.at(i + 1, j), s),
                             mixed(field.at(i, j + 1), field.at(i + 1, j + 1), s), t);
  return std::isfinite(value) ? value : none;
}

}  // namespace catoptric::report
