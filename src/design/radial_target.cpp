#include "design/radial_target.h"

#include <algorithm>
#include <cmath>

#include "design/target.h"

namespace catoptric::design {
namespace {

RadialTarget from_zones(const TargetSpec& spec) {
  RadialTarget target{{}, spec.radii_mm, spec.radii_mm.back(), true};
  target.total_w_per_mm2 = [radii = spec.radii_mm, wanted = spec.irradiances_w_per_mm2](double radius_mm) {
    const auto zone = std::lower_bound(radii.begin(), radii.end(), radius_mm) - radii.begin();
    return zone < static_cast<std::ptrdiff_t>(wanted.size()) ? wanted[static_cast<std::size_t>(zone)] : 0.0;
  };
  return target;
}

RadialTarget from_gaussian(const TargetSpec& spec) {
  RadialTarget target{{}, {spec.reach_mm}, spec.reach_mm, true};
  target.total_w_per_mm2 = [peak = spec.peak_w_per_mm2, sigma = spec.sigma_mm,
                            reach = spec.reach_mm](double radius_mm) {
    const double t = radius_mm / sigma;
    return radius_mm > reach ? 0.0 : peak * std::exp(-0.5 * t * t);
  };
  return target;
}

/// Linear between the table's radii, level within the first, nothing beyond the last.
RadialTarget from_radial_table(const TargetSpec& spec) {
  const std::vector<double>&radii = spec.radii_mm, &wanted = spec.irradiances_w_per_mm2;
  RadialTarget target{{}, {}, radii.back(), true};
  if (wanted.back() > 0) target.jumps_mm.push_back(radii.back());
  target.total_w_per_mm2 = [radii, wanted](double radius_mm) {
    if (radius_mm > radii.back()) return 0.0;
    if (radius_mm <= radii.front()) return wanted.front();
    const auto next =
        static_cast<std::size_t>(std::lower_bound(radii.begin(), radii.end(), radius_mm) - radii.begin());
    const double share = (radius_mm - radii[next - 1]) / (radii[next] - radii[next - 1]);
    return (1 - share) * wanted[next - 1] + share * wanted[next];
  };
  return target;
}

RadialTarget from_paraboloid(const Scene& scene) {
  const double height_mm = std::abs(scene.source.position_mm.z() - scene.near_field.center_mm().z());
  const double rim_mm = scene.target.rim_radius_mm;
  RadialTarget target{{}, {rim_mm}, rim_mm, false};
  target.total_w_per_mm2 = [power_w = scene.source.power_w, a = scene.target.focal_length_mm, rim_mm,
                            height_mm](double radius_mm) {
    return paraboloid_reflected_w_per_mm2(power_w, a, rim_mm, radius_mm) +
           paraboloid_direct_w_per_mm2(power_w, height_mm, radius_mm);
  };
  return target;
}

}  // namespace

std::optional<RadialTarget> radial_target(const Scene& scene) {
  switch (scene.target.kind) {
    case TargetKind::zones:
      return from_zones(scene.target);
    case TargetKind::gaussian:
      return from_gaussian(scene.target);
    case TargetKind::radial:
      return from_radial_table(scene.target);
    case TargetKind::paraboloid:
      return from_paraboloid(scene);
    case TargetKind::none:
    case TargetKind::reflector:
    case TargetKind::csv:
    case TargetKind::image:
      break;
  }
  return std::nullopt;
}

}  // namespace catoptric::design
