#include "design/target.h"

#include <fmt/format.h>

#include <cmath>

#include "base/tolerance.h"
#include "design/csv_table.h"
#include "design/evaluator.h"
#include "design/radial_target.h"
#include "design/stage.h"
#include "sim/accuracy.h"

namespace catoptric::design {
namespace {

/// Streams no evaluation uses, so that a reference and its imitation do not share noise.
constexpr std::uint64_t first_reference_stream = std::uint64_t{1} << 32;
constexpr std::uint64_t reference_replicates = 16;

Target from_radius(const Scene& scene) {
  Target target{scene.near_field.samples(scene.samples), {}};
  const RadialTarget wanted = *radial_target(scene);
  for (const sim::FieldSample& sample : target.samples)
    target.irradiance_w_per_mm2.push_back(
        wanted.total_w_per_mm2(std::hypot(sample.point_mm.x(), sample.point_mm.y())));
  return target;
}

Target from_reference(const Scene& scene) {
  const Profile& reference = *scene.target.reference;
  Target target{scene.near_field.samples(scene.samples), {}};
  const Evaluation first = evaluate_by_rung(scene, make_plan(scene, reference).rung, reference,
                                            target.samples, first_reference_stream);
  target.irradiance_w_per_mm2 = sum(first.direct, first.reflected);
  if (first.rung == sim::Rung::tubes) return target;
  for (std::uint64_t i = 1; i < reference_replicates; ++i)
    target.irradiance_w_per_mm2 =
        sum(target.irradiance_w_per_mm2,
            total_by_rung(scene, first.rung, reference, target.samples, first_reference_stream + i));
  for (double& value : target.irradiance_w_per_mm2) value /= static_cast<double>(reference_replicates);
  return target;
}

Target sharp_from_reference(const Scene& scene) {
  constexpr double share = 0.25;  // of the error allowed, so that the reference's own hardly counts
  const Stage stage(scene, *scene.target.reference);
  Target target{scene.near_field.samples(scene.samples), {}};
  sim::AccuracyRequest request;
  request.relative = share * *scene.accuracy_rel;
  request.model = model_request(scene);
  request.model.estimate = {};
  request.photons = scene.model.photons;
  request.photons.stream = first_reference_stream;
  request.most_photons = scene.model.most_photons;
  const sim::AccurateField field = sim::reach_accuracy(stage.scene, target.samples, request);
  target.irradiance_w_per_mm2 = sum(field.direct, field.reflected);
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
    case TargetKind::zones:
    case TargetKind::gaussian:
    case TargetKind::radial:
      return from_radius(scene);
    case TargetKind::reflector:
      return from_reference(scene);
    case TargetKind::csv:
      return from_table(scene);
    case TargetKind::none:
      break;
  }
  return {scene.near_field.samples(scene.samples), {}};
}

Target make_sharp_target(const Scene& scene) {
  return scene.target.kind == TargetKind::reflector ? sharp_from_reference(scene) : make_target(scene);
}

}  // namespace catoptric::design
