#include "sim/tubes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/tolerance.h"
#include "base/units.h"
#include "sim/radial_panels.h"
#include "sim/tube_kernel.h"
#include "sim/tube_map.h"
#include "sim/tube_rings.h"
#include "sim/tube_setup.h"
#include "sim/tube_sum.h"

namespace catoptric::sim {
namespace {

void check(const PointSource& source, const Profile& profile, const Material& mirror,
           const TubesOptions& options) {
  const Vector3 at = source.position_mm();
  if (std::hypot(at.x(), at.y()) > Tolerance::for_scale(profile.diagonal_mm()).length_mm)
    throw InputError(
        {"the source is off the axis", "tubes", "tubes lie in one meridian plane", "take the photon rung"});
  if (source.tilt_rad() > Tolerance::for_scale(profile.diagonal_mm()).angle_rad)
    throw InputError({"the source's axis is tilted", "tubes",
                      "its light must be alike all round the mirror's", "take the photon rung"});
  if (auto defect = find_defect(mirror)) {
    defect->where = "mirror";
    throw InputError(std::move(*defect));
  }
  if (!is_specular(mirror))
    throw InputError({"the mirror scatters", "tubes", "tubes follow single rays", "take the photon rung"});
  if (!(options.kernel_radius_mm >= 0 && std::isfinite(options.kernel_radius_mm)))
    throw InputError({fmt::format("kernel radius of {} mm", options.kernel_radius_mm), "tubes",
                      "it is positive, or 0 for the pointwise field", ""});
  if (options.most_rays < 100)
    throw InputError({fmt::format("at most {} rays", options.most_rays), "tubes",
                      "the mirror must be looked over once", "allow 1000"});
}

/// Paths fainter than this are given up: all of them together, landing in one place, make a hundredth of the
/// tolerance. Pointwise, below a rounding of the whole.
double least_weight(double power_w, const TubesOptions& options) {
  constexpr double rounding = 1e-16;
  if (!(options.kernel_radius_mm > 0) || !(power_w > 0)) return rounding;
  const double weight =
      0.01 * options.tolerance_w_per_mm2 / (power_w * kernel_peak_per_mm2(options.kernel_radius_mm));
  return std::clamp(weight, rounding, 0.01);
}

constexpr double rays_share = 0.7, interpolation_share = 0.2;

/// The smoothed field by rings, computed at few radii and interpolated between them.
RadialValues smoothed(const TubeMap& map, const AxialLight& light, double h, std::span<const double> radii_mm,
                      double tolerance) {
  const TubeRings rings(map.tubes, light, h, radii_mm, tolerance);
  const RadialFunction function{
      1, [&](std::span<const double> at, std::span<double> values) { rings.smoothed(at, values); }};
  const double allowed[] = {interpolation_share * tolerance};
  RadialValues field = interpolate(function, radii_mm, rings.breaks_mm(), 2 * h, allowed);
  field.error[0] += rings.error_w_per_mm2();
  return field;
}

}  // namespace

TubeTracer tracer_for(const PointSource& source, const Profile& profile, const Material& mirror,
                      const FieldPlane& plane, const TubesOptions& options) {
  check(source, profile, mirror, options);
  return {profile,
          source.position_mm().z(),
          plane,
          mirror,
          {options.most_interactions, least_weight(source.power_w(), options)}};
}

TubeMap map_for(const TubeTracer& tracer, const PointSource& source, const Profile& profile,
                const FieldRadii& radii, const TubesOptions& options) {
  // Of radius 0 alone no width can be taken.
  const double r_max =
      std::max(radii.distinct_mm.back(), Tolerance::for_scale(profile.diagonal_mm()).lift_mm);
  // Rays may use most of the tolerance; rings and interpolation are cheap and get the rest.
  const AxialLight light = AxialLight::of(source);
  return make_tubes(tracer, light.lit(emission_breaks(profile, source.position_mm().z())), light,
                    {r_max, options.kernel_radius_mm, rays_share * options.tolerance_w_per_mm2,
                     options.most_rays, options.most_meetings});
}

TubesField tubes_field(const PointSource& source, const Profile& profile, const Material& mirror,
                       const FieldPlane& plane, std::span<const double> radii_mm,
                       const TubesOptions& options) {
  const TubeTracer tracer = tracer_for(source, profile, mirror, plane, options);
  TubesField field;
  field.irradiance.assign(radii_mm.size(), 0.0);
  if (radii_mm.empty() || source.power_w() <= 0) return field;

  const FieldRadii radii(radii_mm);
  const double h = options.kernel_radius_mm;
  const AxialLight light = AxialLight::of(source);
  const TubeMap map = map_for(tracer, source, profile, radii, options);
  field.error_w_per_mm2 = map.error_w_per_mm2;
  field.rays = map.rays;
  field.landed_w = map.landed_w;
  field.cut_off_w = map.cut_off_w;

  std::vector<double> values(radii.distinct_mm.size(), 0.0);
  if (h > 0) {
    RadialValues smooth = smoothed(map, light, h, radii.distinct_mm, options.tolerance_w_per_mm2);
    field.error_w_per_mm2 += smooth.error[0];
    values = std::move(smooth.values);
  } else {
    const PointwiseSum sum = add_pointwise(map, tracer, light, options.pointwise_tolerance_w_per_mm2,
                                           options.most_rays - map.rays, radii.distinct_mm, values);
    field.error_w_per_mm2 = sum.error_w_per_mm2;
    field.rays += sum.rays;
  }
  // Interpolation leaves roundings of the peak where there is no light, of either sign.
  for (std::size_t i = 0; i < radii.places.size(); ++i)
    field.irradiance[i] = std::max(0.0, values[radii.places[i]]);
  return field;
}

TubesField tubes_field(const Scene& scene, std::span<const FieldSample> samples,
                       const TubesOptions& options) {
  const auto* source = dynamic_cast<const PointSource*>(&scene.source);
  if (const auto objection =
          tubes_objection(scene.source, scene.reflector.profile(), scene.mirror, scene.near_field))
    throw InputError({"the rung tubes does not fit the scene", "", *objection, "take the photon rung"});
  std::vector<double> radii;
  radii.reserve(samples.size());
  for (const FieldSample& sample : samples)
    radii.push_back(std::hypot(sample.point_mm.x(), sample.point_mm.y()));
  const FieldPlane plane{scene.near_field.center_mm().z(), scene.near_field.normal().z() > 0};
  return tubes_field(*source, scene.reflector.profile(), scene.mirror, plane, radii, options);
}

std::optional<std::string> tubes_objection(const Source& source, const Profile& profile,
                                           const Material& mirror, const NearField& near_field) {
  const Tolerance tolerance = Tolerance::for_scale(profile.diagonal_mm());
  if (source.is_sampled()) return "the source is known by its rays alone";
  if (source.extent_mm() > 0) return "the source is extended";
  if (dynamic_cast<const PointSource*>(&source) == nullptr)
    return "the source's intensity is no power of a cosine";
  const Vector3 at = source.position_mm();
  const double off_mm = std::hypot(at.x(), at.y());
  if (off_mm > tolerance.length_mm) return fmt::format("the source is {} mm off the axis", off_mm);
  if (source.tilt_rad() > tolerance.angle_rad)
    return fmt::format("the source's axis is tilted by {} rad", source.tilt_rad());
  const Vector3& normal = near_field.normal();
  if (std::hypot(normal.x(), normal.y()) > tolerance.angle_rad)
    return fmt::format("the near field is tilted against the axis by {} rad",
                       std::atan2(std::hypot(normal.x(), normal.y()), std::abs(normal.z())));
  if (!is_specular(mirror)) return "the mirror scatters, and tubes follow single rays";
  if (near_field.material()) return "the near field is a real object, which stops or scatters light";
  return std::nullopt;
}

}  // namespace catoptric::sim
