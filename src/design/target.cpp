#include "design/target.h"

#include <fmt/format.h>

#include <cmath>

#include "base/tolerance.h"
#include "design/csv_table.h"
#include "design/evaluator.h"

namespace catoptric::design {
namespace {

/// Streams no evaluation uses, so that a reference and its imitation do not share noise.
constexpr std::uint64_t first_reference_stream = std::uint64_t{1} << 32;
constexpr std::uint64_t reference_replicates = 16;

Target from_paraboloid(const Scene& scene) {
  Target target{scene.near_field.samples(scene.samples), {}};
  const double height_mm = std::abs(scene.source.position_mm.z() - scene.near_field.center_mm().z());
  for (const sim::FieldSample& sample : target.samples) {
    const double distance_mm = std::hypot(sample.point_mm.x(), sample.point_mm.y());
    target.irradiance_w_per_mm2.push_back(
        paraboloid_reflected_w_per_mm2(scene.source.power_w, scene.target.focal_length_mm,
                                       scene.target.rim_radius_mm, distance_mm) +
        paraboloid_direct_w_per_mm2(scene.source.power_w, height_mm, distance_mm));
  }
  return target;
}

Target from_reference(const Scene& scene) {
  Target target{scene.near_field.samples(scene.samples), {}};
  target.irradiance_w_per_mm2.assign(target.samples.size(), 0.0);
  for (std::uint64_t i = 0; i < reference_replicates; ++i) {
    const sim::FieldEstimate field =
        estimate_field(scene, *scene.target.reference, target.samples, first_reference_stream + i);
    for (std::size_t j = 0; j < target.samples.size(); ++j)
      target.irradiance_w_per_mm2[j] +=
          (field.direct[j] + field.reflected[j]) / static_cast<double>(reference_replicates);
  }
  return target;
}

Target from_table(const Scene& scene) {
  const std::string file = scene.target.file.string();
  const CsvTable table = read_csv_table(scene.target.file);
  const auto &x = column(table, "x", file), &y = column(table, "y", file), &z = column(table, "z", file);
  const auto& wanted = column(table, scene.target.column, file);
  const double unit_mm = millimetres_per(scene.unit);
  const double reach_mm = std::hypot(scene.near_field.half_width_mm(), scene.near_field.half_height_mm());
  Target target;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Vector3 point_mm = unit_mm * Vector3(x[i], y[i], z[i]);
    const Vector3 offset_mm = point_mm - scene.near_field.center_mm();
    const double height_mm = std::abs(offset_mm.dot(scene.near_field.normal()));
    if (height_mm > 1e-6 * reach_mm ||
        offset_mm.norm() > reach_mm * (1 + 1e-6))  // six digits of a table's numbers
      throw InputError(
          {fmt::format("the point ({}, {}, {}) does not lie on the near field", x[i], y[i], z[i]),
           fmt::format("{}:{}", file, table.lines[i]),
           fmt::format("lengths in the table are in {}, the scene's unit", symbol(scene.unit)),
           "check near_field and the table's unit"});
    if (wanted[i] < 0)
      throw InputError({fmt::format("irradiance {} W/m^2 is negative", wanted[i]),
                        fmt::format("{}:{}", file, table.lines[i]), "", ""});
    target.samples.push_back({point_mm, scene.near_field.normal()});
    target.irradiance_w_per_mm2.push_back(from_w_per_m2(wanted[i]));
  }
  return target;
}

}  // namespace

double paraboloid_reflected_w_per_mm2(double power_w, double focal_length_mm, double rim_radius_mm,
                                      double distance_mm) {
  if (distance_mm > rim_radius_mm) return 0.0;
  const double a = focal_length_mm, p = distance_mm;
  const double widening = 1 + p * p / (4 * a * a);
  return power_w / (4 * pi * a * a * widening * widening);
}

double paraboloid_direct_w_per_mm2(double power_w, double height_mm, double distance_mm) {
  const double h = height_mm, p = distance_mm;
  const double slant = std::sqrt(1 + p * p / (h * h));
  return power_w / (4 * pi * h * h * slant * slant * slant);
}

Target make_target(const Scene& scene) {
  switch (scene.target.kind) {
    case TargetKind::paraboloid:
      return from_paraboloid(scene);
    case TargetKind::reflector:
      return from_reference(scene);
    case TargetKind::csv:
      return from_table(scene);
    case TargetKind::none:
      break;
  }
  return {scene.near_field.samples(scene.samples), {}};
}

}  // namespace catoptric::design
