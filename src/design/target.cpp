#include "design/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "base/ordered_sum.h"
#include "base/tolerance.h"
#include "design/csv_table.h"
#include "design/evaluator.h"
#include "design/far_field.h"
#include "design/field_targets.h"
#include "design/picture.h"
#include "design/radial_target.h"
#include "design/sampling.h"
#include "design/stage.h"
#include "design/target_smoothing.h"
#include "sim/accuracy.h"

namespace catoptric::design {
namespace {

/// Streams no evaluation uses, so that a reference and its imitation do not share noise.
constexpr std::uint64_t first_reference_stream = std::uint64_t{1} << 32;
constexpr std::uint64_t reference_replicates = 16;

double radius_mm(const sim::FieldSample& sample) {
  return std::hypot(sample.point_mm.x(), sample.point_mm.y());
}

Target from_radius(const Scene& scene) {
  Target target{field_samples(scene), {}};
  const RadialTarget wanted = *radial_target(scene);
  for (const sim::FieldSample& sample : target.samples)
    target.irradiance_w_per_mm2.push_back(wanted.total_w_per_mm2(radius_mm(sample)));
  return target;
}

/// What a source that is symmetric about the axis sends straight to a plane across it, by the distance from
/// the axis; else it is no function of the distance, and left to the kernel with the rest.
std::function<double(double)> direct_light(const Scene& scene) {
  const std::shared_ptr<const sim::Source> source = make_source(scene.source);
  const Vector3 position_mm = source->position_mm();
  if (position_mm.x() != 0 || position_mm.y() != 0 || source->tilt_rad() != 0 || !source->is_round())
    return [](double) { return 0.0; };
  return
      [source, z_mm = scene.near_field.center_mm().z(), normal = scene.near_field.normal()](double radius) {
        return source->unhindered_w_per_mm2({radius, 0, z_mm}, normal);
      };
}

/// Whether light is registered on the disc about the axis and nowhere beyond.
bool ends_at_edge(const sim::NearField& field) {
  return field.material() && field.shape() == sim::NearField::Shape::disc && field.center_mm().x() == 0 &&
         field.center_mm().y() == 0;
}

/// The wanted light as an evaluation would show it: direct light is computed without a kernel, so only the
/// rest, which the mirror must give, is seen through it. Beyond the target's reach the mirror is asked for
/// nothing, and what the source sends there by itself is no mirror's fault.
void smooth(const Scene& scene, const RadialTarget& wanted, Target& target) {
  std::vector<double> radii_mm, breaks_mm(scene.target.radii_mm);
  for (const sim::FieldSample& sample : target.samples) radii_mm.push_back(radius_mm(sample));
  breaks_mm.push_back(wanted.reach_mm);
  const auto direct = direct_light(scene);
  const auto from_mirror = [&](double radius) {
    return radius > wanted.reach_mm ? 0.0 : wanted.total_w_per_mm2(radius) - direct(radius);
  };
  target.irradiance_w_per_mm2 = kernel_means(from_mirror, breaks_mm, radii_mm, scene.model.estimate.kernel,
                                             *scene.model.estimate.kernel_radius_mm);
  if (ends_at_edge(scene.near_field)) {
    // Estimates on a real disc know no light beyond it and make up for the kernel's share there.
    const double edge_mm = scene.near_field.half_width_mm();
    breaks_mm.push_back(edge_mm);
    const auto means = [&](const std::function<double(double)>& light) {
      return kernel_means([&](double radius) { return radius > edge_mm ? 0.0 : light(radius); }, breaks_mm,
                          radii_mm, scene.model.estimate.kernel, *scene.model.estimate.kernel_radius_mm);
    };
    target.irradiance_w_per_mm2 = means(from_mirror);
    const std::vector<double> inside = means([](double) { return 1.0; });
    for (std::size_t i = 0; i < inside.size(); ++i) target.irradiance_w_per_mm2[i] /= inside[i];
  }
  for (std::size_t i = 0; i < radii_mm.size(); ++i) target.irradiance_w_per_mm2[i] += direct(radii_mm[i]);
  target.through_kernel = true;
}

/// Weight of a place by its zone, or between the rows of a table.
double weight_at(const TargetSpec& spec, double radius) {
  const auto next = static_cast<std::size_t>(
      std::lower_bound(spec.radii_mm.begin(), spec.radii_mm.end(), radius) - spec.radii_mm.begin());
  if (!spec.zone_weights.empty()) return spec.zone_weights[next];
  if (next == 0) return spec.table_weights.front();
  if (next == spec.radii_mm.size()) return spec.table_weights.back();
  const double share = (radius - spec.radii_mm[next - 1]) / (spec.radii_mm[next] - spec.radii_mm[next - 1]);
  return (1 - share) * spec.table_weights[next - 1] + share * spec.table_weights[next];
}

bool is_within_reach(const Scene& scene, const std::optional<RadialTarget>& wanted,
                     const sim::FieldSample& sample) {
  if (scene.target.picture) return scene.target.picture->covers(scene.near_field.to_plane(sample.point_mm));
  return !wanted || radius_mm(sample) <= wanted->reach_mm;
}

/// Which samples lie in the target's parts, and what each counts.
/// @in    the target without a kernel
void mark(const Scene& scene, Target& target) {
  const auto wanted = radial_target(scene);
  for (std::size_t i = 0; i < target.samples.size(); ++i) {
    target.within_reach.push_back(is_within_reach(scene, wanted, target.samples[i]) ? 1 : 0);
    target.lit.push_back(!target.irradiance_w_per_mm2.empty() && target.irradiance_w_per_mm2[i] > 0 ? 1 : 0);
    if (!scene.target.zone_weights.empty() || !scene.target.table_weights.empty())
      target.weights.push_back(weight_at(scene.target, radius_mm(target.samples[i])));
  }
  if (!target.weights.empty() && !(ordered_sum(target.weights) > 0))
    throw scene.settings.error("target.kind", "no sample has a weight",
                               "all samples lie where zone_weights or the table's weights are 0", "");
}

/// As the picture has it, without the kernel.
Target from_picture(const Scene& scene) {
  Target target{field_samples(scene), {}};
  for (const sim::FieldSample& sample : target.samples)
    target.irradiance_w_per_mm2.push_back(
        scene.target.picture->at(scene.near_field.to_plane(sample.point_mm)));
  return target;
}

Target from_reference(const Scene& scene) {
  const Profile& reference = *scene.target.reference;
  Target target{field_samples(scene), {}};
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
  Target target{field_samples(scene), {}};
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
  for (const auto* each : {&x, &y, &z}) check_range(table, *each, -farthest, farthest, "coordinate", file);
  check_range(table, wanted, 0, greatest_irradiance_w_per_m2, "irradiance", file);
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
    target.samples.push_back({point_mm, scene.near_field.normal()});
    target.irradiance_w_per_mm2.push_back(from_w_per_m2(wanted[i]));
  }
  if (!scene.target.weight_column.empty()) {
    target.weights = column(table, scene.target.weight_column, file);
    check_range(table, target.weights, 0, greatest_weight_of_a_place, "weight", file);
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

namespace {

Target unmarked_target(const Scene& scene) {
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
    case TargetKind::image:
      return from_picture(scene);
    case TargetKind::none:
      break;
  }
  return {field_samples(scene), {}};
}

/// The near field's target, functions of the radius seen through the kernel, but for paraboloids unless
/// asked.
Target kernel_target(const Scene& scene, bool paraboloids_too) {
  Target target = unmarked_target(scene);
  mark(scene, target);
  const auto wanted = radial_target(scene);
  const bool seen_through = paraboloids_too || scene.target.kind != TargetKind::paraboloid;
  if (wanted && seen_through && scene.model.estimate.kernel_radius_mm) smooth(scene, *wanted, target);
  append_fields(scene, target);
  target.far = far_field(scene);
  return target;
}

}  // namespace

Target make_target(const Scene& scene) { return kernel_target(scene, false); }

Target blurred_target(const Scene& scene) { return kernel_target(scene, true); }

Target make_sharp_target(const Scene& scene) {
  Target target =
      scene.target.kind == TargetKind::reflector ? sharp_from_reference(scene) : unmarked_target(scene);
  mark(scene, target);
  target.far = far_field(scene);
  return target;
}

}  // namespace catoptric::design
