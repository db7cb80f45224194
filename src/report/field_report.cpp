#include "report/field_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "design/sampling.h"

namespace catoptric::report {
namespace {

using Json = nlohmann::ordered_json;
using design::Figure;

Figure in_w_per_m2(const Figure& figure) {
  Figure result{to_w_per_m2(figure.value), to_w_per_m2(figure.noise), to_w_per_m2(figure.bias), {}};
  if (figure.half_interval) result.half_interval = to_w_per_m2(*figure.half_interval);
  return result;
}

Json figure_json(const Figure& figure, std::string_view unit, double greatest = HUGE_VAL) {
  return {{"value", figure.value},
          {"unit", std::string(unit)},
          {"noise", figure.noise},
          {"bias", figure.bias},
          {"interval95", interval_json(figure, greatest)}};
}

/// What a surface gets, but for its zones.
Json surface_json(const design::FieldFigures& field, std::string_view irradiance, std::string_view flux) {
  Json json = {{"average", figure_json(in_w_per_m2(field.average_w_per_mm2), irradiance)},
               {"least", figure_json(in_w_per_m2(field.least_w_per_mm2), irradiance)},
               {"greatest", figure_json(in_w_per_m2(field.greatest_w_per_mm2), irradiance)},
               {"uniformity", figure_json(field.uniformity, "1", 1)},
               {"diversity", figure_json(field.diversity, "1", 1)}};
  json["flux"] = field.flux_w ? figure_json(*field.flux_w, flux) : Json(nullptr);
  return json;
}

/// Samples of a table of points are where the table has them.
bool has_spacing(const design::Scene& scene) { return scene.target.kind != design::TargetKind::csv; }

Json samples_json(const design::Scene& scene, std::size_t samples) {
  Json json = {{"number", samples},
               {"grid", scene.grid == design::SampleGrid::en12464 ? "en12464" : "area"},
               {"unit", std::string(symbol(scene.unit))}};
  json["spacing"] = nullptr;
  if (!has_spacing(scene)) return json;
  const design::Spacing apart = spacing(scene);
  json["spacing"] = {scene.to_scene_unit(apart.first_mm), scene.to_scene_unit(apart.second_mm)};
  return json;
}

/// "radius 0 to 12.5 mm", "radius 50 mm and more".
std::string zone_text(const design::Scene& scene, const design::ZoneFigures& zone) {
  const std::string_view unit = symbol(scene.unit);
  const double from = scene.to_scene_unit(zone.from_mm);
  if (!zone.to_mm) return fmt::format("radius {:.4g} {} and more", from, unit);
  return fmt::format("radius {:.4g} to {:.4g} {}", from, scene.to_scene_unit(*zone.to_mm), unit);
}

}  // namespace

Json interval_json(const Figure& figure, double greatest) {
  if (!figure.half_interval) return nullptr;
  const double middle = figure.value - figure.bias;
  return {std::clamp(middle - *figure.half_interval, 0.0, greatest),
          std::clamp(middle + *figure.half_interval, 0.0, greatest)};
}

Json field_json(const design::Scene& scene, const design::Judgement& judgement) {
  const design::FieldFigures& field = judgement.field;
  const std::string_view irradiance = irradiance_unit(scene.source.quantity),
                         flux = flux_unit(scene.source.quantity);
  Json json = surface_json(field, irradiance, flux);
  json["zones"] = Json::array();
  for (const design::ZoneFigures& zone : field.zones)
    json["zones"].push_back({{"about", field.zones_about_axis ? "axis" : "centre"},
                             {"from", scene.to_scene_unit(zone.from_mm)},
                             {"to", zone.to_mm ? Json(scene.to_scene_unit(*zone.to_mm)) : Json(nullptr)},
                             {"unit", std::string(symbol(scene.unit))},
                             {"samples", zone.samples},
                             {"flux", figure_json(zone.flux_w, flux)},
                             {"average", figure_json(in_w_per_m2(zone.irradiance_w_per_mm2), irradiance)}});
  std::size_t further_samples = 0;
  json["further"] = Json::object();
  for (const design::FurtherFigures& further : judgement.further) {
    json["further"][further.name] = surface_json(further.figures, irradiance, flux);
    json["further"][further.name]["samples"] = further.samples;
    json["further"][further.name]["spacing"] = scene.to_scene_unit(further.spacing_mm);
    further_samples += further.samples;
  }
  json["samples"] = samples_json(scene, judgement.reflected.size() - further_samples);
  return json;
}

Table field_table(const design::Scene& scene, const design::Judgement& judgement) {
  const design::FieldFigures& field = judgement.field;
  Table table{
      {{"on the near field", ""}, {"unit", ""}, {"value", ""}, {"noise (1 sigma)", "", 2}, {"bias", "", 2}},
      {}};
  const auto add = [&](const std::string& name, std::string_view unit, const Figure& figure) {
    table.rows.push_back({name, std::string(unit), figure.value, figure.noise, figure.bias});
  };
  const std::string_view irradiance = irradiance_unit(scene.source.quantity),
                         flux = flux_unit(scene.source.quantity);
  const std::string light(irradiance_name(scene.source.quantity));
  add("average " + light, irradiance, in_w_per_m2(field.average_w_per_mm2));
  add("least", irradiance, in_w_per_m2(field.least_w_per_mm2));
  add("greatest", irradiance, in_w_per_m2(field.greatest_w_per_mm2));
  add("U0, least / average", "", field.uniformity);
  add("Ud, least / greatest", "", field.diversity);
  if (field.flux_w) add("flux", flux, *field.flux_w);
  for (const design::ZoneFigures& zone : field.zones) {
    add("flux, " + zone_text(scene, zone), flux, zone.flux_w);
    add("  its average " + light, irradiance, in_w_per_m2(zone.irradiance_w_per_mm2));
  }
  std::size_t further_samples = 0;
  for (const design::FurtherFigures& further : judgement.further) further_samples += further.samples;
  table.rows.push_back(
      {"samples: " + samples_text(scene, judgement.reflected.size() - further_samples), "", {}, {}, {}});
  for (const auto& [name, samples, spacing_mm, figures] : judgement.further) {
    table.rows.push_back({fmt::format("{}: {} samples, {:.4g} {} apart on average", name, samples,
                                      scene.to_scene_unit(spacing_mm), symbol(scene.unit)),
                          "",
                          {},
                          {},
                          {}});
    add("  its average " + light, irradiance, in_w_per_m2(figures.average_w_per_mm2));
    add("  its U0", "", figures.uniformity);
    add("  its flux", flux, *figures.flux_w);
  }
  return table;
}

std::string samples_text(const design::Scene& scene, std::size_t samples) {
  if (!has_spacing(scene)) return fmt::format("{} of the target's table", samples);
  const design::Spacing apart = spacing(scene);
  const double first = scene.to_scene_unit(apart.first_mm), second = scene.to_scene_unit(apart.second_mm);
  const std::string_view unit = symbol(scene.unit);
  const std::string distance = scene.near_field.shape() == sim::NearField::Shape::disc
                                   ? fmt::format("{:.4g} {} apart on average", first, unit)
                                   : fmt::format("{:.4g} by {:.4g} {} apart", first, second, unit);
  return fmt::format("{}{}, {}", samples,
                     scene.grid == design::SampleGrid::en12464 ? " on the grid of EN 12464-1" : "", distance);
}

}  // namespace catoptric::report
