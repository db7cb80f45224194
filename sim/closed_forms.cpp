#include "sim/closed_forms.h"

#include <cmath>
#include <functional>

#include "base/profile.h"
#include "base/tolerance.h"
#include "base/units.h"
#include "sim/opening.h"

namespace catoptric::sim {
namespace {

/// Whether an equation of second degree in r and z, given as a length, holds along the whole generatrix.
/// On a span of degree p it is a polynomial of degree 2 p: as many points and one more decide.
bool holds_along(const Profile& profile, const std::function<double(double r, double z)>& off_mm) {
  const double tolerance = Tolerance::for_scale(profile.diagonal_mm()).length_mm;
  for (const RationalSpan& span : profile.spans())
    for (int i = 0; i <= 2 * profile.degree(); ++i) {
      const MeridianPoint at = evaluate(span, static_cast<double>(i) / (2 * profile.degree()));
      if (!(std::abs(off_mm(at.r_mm, at.z_mm)) <= tolerance)) return false;
    }
  return true;
}

struct Rings {
  double least_r_mm, greatest_r_mm;
};

Rings extent(const Profile& profile) {
  const double first = profile.at(profile.first_parameter()).r_mm;
  const double last = profile.at(profile.last_parameter()).r_mm;
  return {std::min(first, last), std::max(first, last)};
}

/// The paraboloid z = focus + up (a - r^2 / 4 a), whose beam goes against `up`.
std::optional<ClosedForm> paraboloid(const Scene& scene, std::span<const FieldSample> samples) {
  const Profile& profile = scene.reflector.profile();
  const double focus_mm = scene.source.position_mm().z();
  const MeridianPoint end = profile.at(profile.last_parameter());
  for (const double up : {1.0, -1.0}) {
    // At any point the distance to the focus is 2 a less the height above it: a from the rim.
    const double height = up * (end.z_mm - focus_mm), a = 0.5 * (height + std::hypot(end.r_mm, height));
    if (!(a > 0) || !holds_along(profile, [&](double r, double z) {
          return (up * (z - focus_mm) - a + r * r / (4 * a)) / std::hypot(1.0, r / (2 * a));
        }))
      continue;
    const Rings rings = extent(profile);
    ClosedForm form{"paraboloid with the source in its focus", {}};
    for (const FieldSample& sample : samples) {
      const double r = std::hypot(sample.point_mm.x(), sample.point_mm.y());
      const double surface = focus_mm + up * (a - r * r / (4 * a));
      if (up * (surface - sample.point_mm.z()) <= 0 && r <= rings.greatest_r_mm) return std::nullopt;
      const double widening = 1 + r * r / (4 * a * a);
      const double facing = std::max(0.0, up * sample.normal.z());
      const bool lit = r >= rings.least_r_mm && r <= rings.greatest_r_mm;
      const Vector3 way(sample.point_mm.x(), sample.point_mm.y(), surface - focus_mm);
      // The incidence on a paraboloid has the tangent r / 2 a.
      form.reflected.push_back(lit ? scene.mirror.reflectance_at(1 / std::sqrt(widening)) *
                                         scene.source.intensity_w_per_sr(way.normalized()) * facing /
                                         (a * a * widening * widening)
                                   : 0.0);
    }
    return form;
  }
  return std::nullopt;
}

/// The sphere about the source.
std::optional<ClosedForm> sphere(const Scene& scene, std::span<const FieldSample> samples) {
  const Profile& profile = scene.reflector.profile();
  const Vector3 center_mm = scene.source.position_mm();
  const MeridianPoint end = profile.at(profile.last_parameter());
  const double radius_mm = std::hypot(end.r_mm, end.z_mm - center_mm.z());
  if (!holds_along(profile, [&](double r, double z) { return std::hypot(r, z - center_mm.z()) - radius_mm; }))
    return std::nullopt;
  const auto probe = scene.reflector.probe();
  const double lift_mm = Tolerance::for_scale(profile.diagonal_mm()).lift_mm;
  ClosedForm form{"sphere about the source", {}};
  for (const FieldSample& sample : samples) {
    const Vector3 way = sample.point_mm - center_mm;
    const double distance_mm = way.norm();
    if (!(distance_mm > lift_mm) || probe->first_hit({center_mm, way / distance_mm}, lift_mm))
      return std::nullopt;  // light comes back a second time, or is stopped
    const bool lit = probe->first_hit({center_mm, -way / distance_mm}, lift_mm).has_value();
    const double cosine = std::max(0.0, -sample.normal.dot(way) / distance_mm);
    form.reflected.push_back(lit ? scene.mirror.reflectance_at(1) *
                                       scene.source.intensity_w_per_sr(-way / distance_mm) * cosine /
                                       (distance_mm * distance_mm)
                                 : 0.0);
  }
  return form;
}

}  // namespace

std::optional<ClosedForm> closed_form(const Scene& scene, std::span<const FieldSample> samples) {
  const Vector3& source_mm = scene.source.position_mm();
  const Profile& profile = scene.reflector.profile();
  if (!scene.is_bare() || scene.source.is_sampled() || scene.source.extent_mm() > 0 || source_mm.x() != 0 ||
      source_mm.y() != 0 || scene.mirror.transmittance > 0 || !is_specular(scene.mirror) ||
      scene.near_field.material() || !Opening::of(profile))
    return std::nullopt;
  if (auto form = paraboloid(scene, samples)) return form;
  return sphere(scene, samples);
}

}  // namespace catoptric::sim
