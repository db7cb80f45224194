#include "design/constraint_settings.h"

#include <fmt/format.h>

#include <cmath>

namespace catoptric::design {
namespace {

void check_order(const Settings& settings, const char* key, double low, double high) {
  if (low < high) return;
  throw settings.error(key, fmt::format("leaves no room between {} and {}", low, high),
                       "the lower limit is less than the upper", "swap them");
}

Constraints::Landing landing(const Settings& settings, const Vector3& source_mm,
                             const sim::NearField& field) {
  const bool across = std::abs(std::abs(field.normal().z()) - 1) < 1e-12;  // roundings of a unit vector
  if (source_mm.x() != 0 || source_mm.y() != 0 || !across)
    throw settings.error("constraints.no_folds", "cannot be judged here",
                         "it follows rays from the axis to a near field across it",
                         "leave it out, or move the source onto the z axis");
  return {source_mm.z(), field.center_mm().z(), field.half_width_mm()};
}

}  // namespace

Constraints read_constraints(const Settings& settings, double unit_mm, const Vector3& source_mm,
                             const sim::NearField& field) {
  const auto length = [&](const char* key) {
    auto value = settings.number(std::string("constraints.") + key);
    if (value) *value *= unit_mm;
    return value;
  };
  Constraints result;
  result.rim_radius_min_mm = length("rim_radius_min");
  result.rim_radius_max_mm = length("rim_radius_max");
  if (result.rim_radius_min_mm && result.rim_radius_max_mm)
    check_order(settings, "constraints.rim_radius_max", *settings.number("constraints.rim_radius_min"),
                *settings.number("constraints.rim_radius_max"));
  result.height_max_mm = length("height_max");
  result.opening_min_mm = length("opening_min");
  result.envelope_radius_mm = length("envelope_radius");
  if (const auto z = settings.numbers("constraints.envelope_z")) {
    check_order(settings, "constraints.envelope_z", (*z)[0], (*z)[1]);
    result.envelope_low_mm = (*z)[0] * unit_mm;
    result.envelope_high_mm = (*z)[1] * unit_mm;
  }
  result.curvature_radius_min_mm = length("curvature_radius_min");
  if (const auto degrees = settings.number("constraints.draft_angle_min"))
    result.draft_angle_min_rad = *degrees * pi / 180;
  result.wall_mm = length("wall");
  result.wall_outside = settings.text("reflector.wall_side").value_or("outside") == "outside";
  if (settings.boolean("constraints.no_folds").value_or(false))
    result.no_folds = landing(settings, source_mm, field);
  return result;
}

}  // namespace catoptric::design
