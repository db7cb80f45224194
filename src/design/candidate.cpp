#include "design/candidate.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "base/contract.h"
#include "base/profile_limits.h"
#include "cad/opening.h"
#include "design/variables.h"
#include "sim/cylinder_source.h"
#include "sim/disc_source.h"
#include "sim/intensity_source.h"
#include "sim/rectangle_source.h"
#include "sim/source_group.h"
#include "sim/sphere_source.h"

namespace catoptric::design {
namespace {

constexpr std::array<std::pair<SceneVariable, std::string_view>, 7> names{
    {{SceneVariable::source_x, "source.x"},
     {SceneVariable::source_y, "source.y"},
     {SceneVariable::source_z, "source.z"},
     {SceneVariable::source_power, "source.power"},
     {SceneVariable::source_flux, "source.flux"},
     {SceneVariable::source_exponent, "source.exponent"},
     {SceneVariable::reflectance, "reflector.reflectance"}}};

/// The number in a candidate that a variable stands for: lengths in mm.
template <typename AnyCandidate>
auto& number_of(AnyCandidate& candidate, SceneVariable variable) {
  switch (variable) {
    case SceneVariable::source_x:
      return candidate.source.position_mm[0];
    case SceneVariable::source_y:
      return candidate.source.position_mm[1];
    case SceneVariable::source_z:
      return candidate.source.position_mm[2];
    case SceneVariable::source_power:
    case SceneVariable::source_flux:
      return candidate.source.power_w;
    case SceneVariable::source_exponent:
      return candidate.source.exponent;
    case SceneVariable::reflectance:
      break;
  }
  return candidate.mirror.reflectance;
}

std::vector<std::string> shape_names(const std::vector<std::string>& all) {
  std::vector<std::string> shape;
  for (const std::string& each : all)
    if (!parse_scene_variable(each)) shape.push_back(each);
  return shape;
}

/// Where the group stands, and as bright as it is.
std::unique_ptr<sim::Source> make_group(const SourceSpec& spec) {
  double power_w = 0;
  for (const SourceSpec& part : spec.parts) power_w += part.power_w;
  std::vector<std::unique_ptr<const sim::Source>> parts;
  for (SourceSpec part : spec.parts) {
    part.position_mm += spec.position_mm;
    if (power_w != spec.power_w) part.power_w *= spec.power_w / power_w;
    parts.push_back(make_source(part));
  }
  return std::make_unique<sim::SourceGroup>(std::move(parts));
}

}  // namespace

std::unique_ptr<sim::Source> make_source(const SourceSpec& spec) {
  const Vector3& at_mm = spec.position_mm;
  switch (spec.kind) {
    case SourceKind::disc:
      return std::make_unique<sim::LambertianDisc>(at_mm, spec.radius_mm, spec.axis, spec.power_w);
    case SourceKind::rectangle:
      return std::make_unique<sim::LambertianRectangle>(at_mm, spec.axis, spec.along, spec.width_mm,
                                                        spec.height_mm, spec.power_w);
    case SourceKind::sphere:
      return std::make_unique<sim::LambertianSphere>(at_mm, spec.radius_mm, spec.power_w);
    case SourceKind::cylinder:
      return std::make_unique<sim::LambertianCylinder>(at_mm, spec.axis, spec.radius_mm, spec.length_mm,
                                                       spec.power_w);
    case SourceKind::intensity:
      return std::make_unique<sim::IntensitySource>(at_mm, spec.power_w, spec.table, spec.axis, spec.along);
    case SourceKind::rays:
      return std::make_unique<sim::RaySource>(at_mm, spec.power_w, spec.rays, spec.axis, spec.along);
    case SourceKind::several:
      return make_group(spec);
    case SourceKind::point:
      break;
  }
  return std::make_unique<sim::PointSource>(at_mm, spec.power_w, spec.exponent, spec.axis);
}

std::optional<double> far_exponent(const SourceSpec& spec) {
  switch (spec.kind) {
    case SourceKind::disc:
    case SourceKind::rectangle:
      return 1;
    case SourceKind::sphere:
      return 0;
    case SourceKind::cylinder:
    case SourceKind::intensity:
    case SourceKind::rays:
    case SourceKind::several:
      return std::nullopt;
    case SourceKind::point:
      break;
  }
  return spec.exponent;
}

std::optional<SceneVariable> parse_scene_variable(std::string_view name) {
  for (const auto& [variable, text] : names)
    if (text == name) return variable;
  return std::nullopt;
}

std::string scene_variable_names() {
  std::string list;
  for (const auto& [variable, text] : names) list += fmt::format("{}{}", list.empty() ? "" : ", ", text);
  return list;
}

bool is_length(SceneVariable variable) {
  return variable == SceneVariable::source_x || variable == SceneVariable::source_y ||
         variable == SceneVariable::source_z;
}

bool is_variable(const std::string& name, const Candidate& base) {
  return parse_scene_variable(name) || parse_component(name, base.profile.points().size());
}

std::string variables_rule(const Candidate& base) {
  return fmt::format("variables are r0, z0, w0 ... r{0}, z{0}, w{0}, {1}", base.profile.points().size() - 1,
                     scene_variable_names());
}

std::string unit_of_variable(std::string_view name, LengthUnit unit) {
  const auto beside = parse_scene_variable(name);
  if (beside == SceneVariable::source_power) return "W";
  if (beside == SceneVariable::source_flux) return "lm";
  if (name.starts_with("angle")) return "rad";
  if (name.starts_with("kappa")) return "1/" + std::string(symbol(unit));
  const bool length = beside ? is_length(*beside) : name.front() != 'w' && !name.starts_with("logw");
  return length ? std::string(symbol(unit)) : "";
}

double scene_value(const Candidate& candidate, SceneVariable variable, LengthUnit unit) {
  return number_of(candidate, variable) / (is_length(variable) ? millimetres_per(unit) : 1);
}

std::optional<std::string> value_defect(const Candidate& base, SceneVariable variable, double value) {
  if (!std::isfinite(value)) return "it is a finite number";
  if (variable == SceneVariable::source_power || variable == SceneVariable::source_flux) {
    if ((variable == SceneVariable::source_flux) != (base.source.quantity == LightQuantity::luminous))
      return fmt::format("the source's light is in {}", flux_unit(base.source.quantity));
    if (!(value > 0)) return "a source's power is positive";
  }
  if (variable == SceneVariable::source_exponent) {
    if (base.source.kind != SourceKind::point) return "only a point source has an exponent";
    // Exponent 0 is another law, with light behind too, which no small exponent comes near.
    if (!(value > 0 && value <= sim::greatest_exponent))
      return fmt::format("an exponent that varies lies above 0, up to {}", sim::greatest_exponent);
  }
  if (variable == SceneVariable::reflectance) {
    if (base.mirror.by_angle) return "the mirror's reflectance goes with the angle, and is no single number";
    if (!(value >= 0 && value + base.mirror.diffuse + base.mirror.transmittance <= 1))
      return "reflectance lies between 0 and what diffuse reflectance and transmittance leave of 1";
  }
  return std::nullopt;
}

SceneFamily::SceneFamily(Candidate base, const std::vector<std::string>& all, LengthUnit unit,
                         std::optional<double> opening_mm)
    : SceneFamily(base, ProfileFamily(base.profile, shape_names(all), unit), all, unit, opening_mm) {}

SceneFamily::SceneFamily(Candidate base, ShapeFamily shape, const std::vector<std::string>& all,
                         LengthUnit unit, std::optional<double> opening_mm)
    : base_(std::move(base)),
      shape_(std::move(shape)),
      unit_mm_(millimetres_per(unit)),
      opening_mm_(opening_mm) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (const auto variable = parse_scene_variable(all[i])) {
      scene_places_.push_back(i);
      scene_variables_.push_back(*variable);
    } else {
      shape_places_.push_back(i);
    }
  }
}

std::optional<Candidate> SceneFamily::at(std::span<const double> values) const {
  std::optional<Candidate> candidate = whole_at(values);
  if (!candidate || !opening_mm_) return candidate;
  try {
    candidate->profile = cad::with_opening(candidate->profile, *opening_mm_);
  } catch (const Error&) {  // of such a shape the opening leaves nothing, or more than one piece
    return std::nullopt;
  }
  return candidate;
}

std::optional<Candidate> SceneFamily::whole_at(std::span<const double> values) const {
  CATOPTRIC_EXPECTS(values.size() == shape_places_.size() + scene_places_.size());
  std::vector<double> shape;
  for (const std::size_t place : shape_places_) shape.push_back(values[place]);
  auto profile = std::visit([&](const auto& each) { return each.at(shape); }, shape_);
  if (!profile || weight_ratio(profile->degree(), profile->points()) > greatest_weight_ratio)
    return std::nullopt;
  Candidate candidate{std::move(*profile), base_.source, base_.mirror};
  for (std::size_t i = 0; i < scene_places_.size(); ++i) {
    const SceneVariable variable = scene_variables_[i];
    const double value = values[scene_places_[i]];
    if (value_defect(base_, variable, value)) return std::nullopt;
    number_of(candidate, variable) = is_length(variable) ? value * unit_mm_ : value;
  }
  return candidate;
}

}  // namespace catoptric::design
