#include "design/sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "design/scene_defaults.h"

namespace catoptric::design {
namespace {

constexpr double most_samples = 1e6;

/// The least number of cells that are no longer than `longest`; a length that is a whole number of them but
/// for rounding takes that.
double cells(double length, double longest) {
  constexpr double rounding = 1e-9;
  return std::max(1.0, std::ceil(length / longest - rounding));
}

std::vector<sim::FieldSample> grid_samples(const sim::NearField& field, const MeasuringGrid& grid) {
  std::vector<sim::FieldSample> samples;
  const auto place = [](std::size_t i, std::size_t count, double half_mm) {
    return half_mm * ((2 * static_cast<double>(i) + 1) / static_cast<double>(count) - 1);
  };
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column)
      samples.push_back({field.to_space({place(column, grid.columns, field.half_width_mm()),
                                         place(row, grid.rows, field.half_height_mm())}),
                         field.normal()});
  return samples;
}

MeasuringGrid grid_of(const sim::NearField& field) {
  return en12464_grid(2 * field.half_width_mm(), 2 * field.half_height_mm());
}

}  // namespace

MeasuringGrid en12464_grid(double width_mm, double height_mm) {
  constexpr double longest_mm = 10e3;
  const double longer = std::max(width_mm, height_mm), shorter = std::min(width_mm, height_mm);
  const double deciding_m = (longer >= 2 * shorter ? shorter : longer) / 1e3;
  const double spacing_mm = std::min(longest_mm, 1e3 * 0.2 * std::pow(5.0, std::log10(deciding_m)));
  const double columns = cells(width_mm, spacing_mm), rows = cells(height_mm, spacing_mm);
  if (!(columns * rows <= most_samples))
    throw InputError({fmt::format("a grid of {:g} by {:g} points is too large", columns, rows),
                      "near_field.grid", fmt::format("at most {:g} are taken", most_samples),
                      "near_field.grid = \"area\" with near_field.samples"});
  return {static_cast<std::size_t>(columns), static_cast<std::size_t>(rows), spacing_mm};
}

void complete_samples(Settings& settings) {
  if (settings.text("near_field.grid") != "en12464") return;
  if (settings.text("near_field.shape") == "disc")
    throw settings.error("near_field.grid", "does not fit a disc", "the standard's grid is one of rectangles",
                         "near_field.shape = \"rectangle\" about it, or near_field.grid = \"area\"");
  if (settings.text("target.kind") == "csv")
    throw settings.error("near_field.grid", "has no effect", "the points of the target's table are looked at",
                         "remove it");
  const double unit_mm = millimetres_per(scene_unit(settings));
  const MeasuringGrid grid = en12464_grid(unit_mm * *settings.number("near_field.width"),
                                          unit_mm * *settings.number("near_field.height"));
  const auto count = static_cast<std::int64_t>(grid.columns * grid.rows);
  if (settings.where("near_field.samples") != "default" && settings.integer("near_field.samples") != count)
    throw settings.error("near_field.samples", "stands beside a grid that has its own number",
                         fmt::format("it has {} by {} points", grid.columns, grid.rows), "remove it");
  settings.set({"near_field.samples", fmt::format("{}", count), "default"});
}

std::vector<sim::FieldSample> field_samples(const Scene& scene) {
  return scene.grid == SampleGrid::en12464 ? grid_samples(scene.near_field, grid_of(scene.near_field))
                                           : scene.near_field.samples(scene.samples);
}

Spacing spacing(const Scene& scene) {
  const sim::NearField& field = scene.near_field;
  const std::vector<sim::FieldSample> samples = field_samples(scene);
  const double count = static_cast<double>(samples.size());
  if (field.shape() == sim::NearField::Shape::disc) {
    const double mean_mm = std::sqrt(field.area_mm2() / count);
    return {mean_mm, mean_mm};
  }
  // Rows lie one after the other, each along the first axis.
  const double first_mm = field.to_plane(samples.front().point_mm).y();
  const double a_row_mm = 1e-9 * field.half_height_mm();
  const auto columns = std::count_if(samples.begin(), samples.end(), [&](const sim::FieldSample& sample) {
    return std::abs(field.to_plane(sample.point_mm).y() - first_mm) <= a_row_mm;
  });
  const double in_row = static_cast<double>(columns);
  return {2 * field.half_width_mm() / in_row, 2 * field.half_height_mm() * in_row / count};
}

}  // namespace catoptric::design
