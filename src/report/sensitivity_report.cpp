#include "report/sensitivity_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "report/figures.h"
#include "report/page_parts.h"
#include "report/result_json.h"
#include "report/run_folder.h"

namespace catoptric::report {
namespace {

using Json = nlohmann::ordered_json;
using Parameters = std::vector<design::ParameterSensitivity>;

double share(const design::Sensitivity& sensitivity) {
  return 1 / std::sqrt(static_cast<double>(std::max<std::size_t>(1, sensitivity.budgeted())));
}

std::string derivative_unit(const design::Scene& scene, const design::Deviation& deviation) {
  const std::string irradiance(irradiance_unit(scene.source.quantity));
  return deviation.unit.empty() ? irradiance : irradiance + " per " + deviation.unit;
}

std::vector<double> scaled(const std::vector<double>& w_per_mm2, double factor) {
  std::vector<double> values;
  for (const double value : w_per_mm2) values.push_back(to_w_per_m2(factor * value));
  return values;
}

std::vector<double> radii(const design::Scene& scene, const design::Sensitivity& sensitivity) {
  std::vector<double> list;
  for (const double radius_mm : sensitivity.radii_mm) list.push_back(scene.to_scene_unit(radius_mm));
  return list;
}

std::vector<NamedFigure> figures(const design::Scene& scene, const design::Sensitivity& sensitivity) {
  const std::vector<double> r = radii(scene, sensitivity);
  const std::string x_label = fmt::format("distance from the centre ({})", symbol(scene.unit));
  const std::string name(irradiance_name(scene.source.quantity));
  const std::string irradiance = printed(irradiance_unit(scene.source.quantity));
  LineFigure all{"Change of " + name + " at each tolerance", x_label, "change (" + irradiance + ")", {}, {}};
  std::vector<NamedFigure> list;
  for (const design::ParameterSensitivity& each : sensitivity.parameters) {
    if (each.derivative_w_per_mm2.empty()) continue;
    const std::string& unit = each.deviation.unit;
    if (const auto tolerance = each.tolerance())
      all.curves.push_back({fmt::format("{}, {:.3g} {}", each.deviation.name, *tolerance, unit), r,
                            scaled(each.derivative_w_per_mm2, *tolerance)});
    list.push_back({"derivative-" + each.deviation.key, "Derivative by " + each.deviation.name,
                    line_script({"Derivative by " + each.deviation.name,
                                 x_label,
                                 fmt::format("dE/dp ({})", printed(derivative_unit(scene, each.deviation))),
                                 {{"dE/dp", r, scaled(each.derivative_w_per_mm2, 1), CurveRole::obtained}},
                                 {}})});
  }
  list.insert(list.begin(), {"sensitivity", "What each deviation, at its tolerance, does to the " + name,
                             line_script(all)});
  return list;
}

Json tolerated_json(const std::optional<design::Tolerated>& tolerated) {
  if (!tolerated) return nullptr;
  return {{"deviation", tolerated->deviation},
          {"change", tolerated->change.value_rel},
          {"noise", tolerated->change.noise_rel}};
}

Json parameter_json(const design::ParameterSensitivity& each, double budget_share) {
  Json json = {{"name", each.deviation.name},
               {"key", each.deviation.key},
               {"unit", each.deviation.unit},
               {"meaning", each.deviation.meaning},
               {"model", std::string(name(each.rung))},
               {"replicates", each.replicates},
               {"change_per_unit", each.change_per_unit.value_rel},
               {"change_per_unit_noise", each.change_per_unit.noise_rel},
               {"step", each.step},
               {"nonlinearity", each.nonlinearity_rel},
               {"minus", tolerated_json(each.minus)},
               {"plus", tolerated_json(each.plus)}};
  const auto tolerance = each.tolerance();
  json["tolerance"] = tolerance ? Json(*tolerance) : Json(nullptr);
  json["tolerance_in_budget"] = tolerance ? Json(*tolerance * budget_share) : Json(nullptr);
  return json;
}

Json sensitivity_json(const design::Scene& scene, const design::Sensitivity& sensitivity) {
  Json parameters = Json::array();
  for (const auto& each : sensitivity.parameters)
    parameters.push_back(parameter_json(each, share(sensitivity)));
  return {{"title", scene.title},
          {"command", "sensitivity"},
          {"unit", std::string(symbol(scene.unit))},
          {"allowed", sensitivity.allowed_rel},
          {"field_rms", to_w_per_m2(sensitivity.field_rms_w_per_mm2)},
          {"kernel_radius", scene.model.estimate.kernel_radius_mm
                                ? Json(scene.to_scene_unit(*scene.model.estimate.kernel_radius_mm))
                                : Json(nullptr)},
          {"budgeted", sensitivity.budgeted()},
          {"parameters", parameters},
          {"sentence", budget_sentence(sensitivity)},
          {"photons", sensitivity.photons},
          {"seconds", sensitivity.seconds},
          {"seed", scene.seed},
          {"version", version()}};
}

/// Why some are by photons, and what the derivatives are worth.
std::vector<std::string> remarks(const design::Sensitivity& sensitivity) {
  std::vector<std::string> list;
  for (const auto& each : sensitivity.parameters)
    if (each.deviation.key == "source_lateral")
      list.push_back(
          each.rung == sim::Rung::photons
              ? "A source beside the axis breaks the symmetry that tubes and rings live on, so that row is "
                "by "
                "photons in space, with the same random numbers before and after; to first order the field "
                "is "
                "tilted: brighter on one side, darker on the other. The derivative is shown in the direction "
                "of the shift."
              : "The derivative by the source's shift across the axis is shown in the direction of the "
                "shift.");
  list.emplace_back(
      "Changes are those of the field as the scene's kernel shows it. Nonlinearity compares the derivative "
      "with "
      "one of twice the step; where it is not small, tolerances, which are found by simulation, say more "
      "than "
      "derivatives.");
  return list;
}

}  // namespace

std::string budget_sentence(const design::Sensitivity& sensitivity) {
  return fmt::format(
      "Each tolerance alone changes the field by {:.3g} (relative, rms); all {} at once, independent of each "
      "other, by {:.3g} (root sum of squares). For {:.3g} in all, allow each {:.3g} of its own.",
      sensitivity.allowed_rel, sensitivity.budgeted(), sensitivity.allowed_rel / share(sensitivity),
      sensitivity.allowed_rel, share(sensitivity));
}

Table tolerance_table(const design::Sensitivity& sensitivity) {
  Table table{{{"deviation", ""},
               {"unit", ""},
               {"minus", "", 3},
               {"plus", "", 3},
               {"tolerance", "", 3},
               {"change there", "", 3},
               {"noise", "", 2},
               {"in budget", "", 3},
               {"change per unit", "", 3},
               {"noise per unit", "", 2},
               {"nonlinearity", "", 2},
               {"model", ""}},
              {}};
  for (const design::ParameterSensitivity& each : sensitivity.parameters) {
    const auto tolerance = each.tolerance();
    const auto& at = each.plus && tolerance == each.plus->deviation ? each.plus : each.minus;
    table.rows.push_back(
        {each.deviation.name, each.deviation.unit, each.minus ? Cell{each.minus->deviation} : Cell{},
         each.plus ? Cell{each.plus->deviation} : Cell{}, tolerance ? Cell{*tolerance} : Cell{},
         at ? Cell{at->change.value_rel} : Cell{}, at ? Cell{at->change.noise_rel} : Cell{},
         tolerance ? Cell{*tolerance * share(sensitivity)} : Cell{}, each.change_per_unit.value_rel,
         each.change_per_unit.noise_rel, each.nonlinearity_rel, std::string(name(each.rung))});
  }
  return table;
}

PageSection tolerance_section(const design::Sensitivity& sensitivity) {
  constexpr std::size_t main_columns[] = {0, 1, 2, 3, 4, 5, 6, 7, 11};
  const Table all = tolerance_table(sensitivity);
  Table table;
  for (const std::size_t column : main_columns) table.columns.push_back(all.columns[column]);
  for (const auto& row : all.rows) {
    table.rows.emplace_back();
    for (const std::size_t column : main_columns) table.rows.back().push_back(row[column]);
  }
  PageSection section{"Tolerances", {budget_sentence(sensitivity)}, {}, {{"", std::move(table)}}, {}};
  for (const auto& each : sensitivity.parameters)
    section.facts.emplace_back(each.deviation.name, each.deviation.meaning);
  section.paragraphs.emplace_back(
      "Changes are those of the field as the scene's kernel shows it, root mean square over the samples, "
      "relative "
      "to the field. What is by photons here is by few of them; catoptric sensitivity takes as many as the "
      "scene "
      "says.");
  return section;
}

Table derivative_table(const design::Scene& scene, const design::Sensitivity& sensitivity) {
  Table table{{{"r", std::string(symbol(scene.unit))},
               {"field", std::string(irradiance_unit(scene.source.quantity))}},
              {}};
  for (const auto& each : sensitivity.parameters) {
    table.columns.push_back({each.deviation.key, derivative_unit(scene, each.deviation)});
    table.columns.push_back({each.deviation.key + "_noise", derivative_unit(scene, each.deviation)});
  }
  for (std::size_t i = 0; i < sensitivity.radii_mm.size(); ++i) {
    std::vector<Cell> row{scene.to_scene_unit(sensitivity.radii_mm[i]),
                          to_w_per_m2(sensitivity.field_w_per_mm2[i])};
    for (const auto& each : sensitivity.parameters) {
      const bool known = !each.derivative_w_per_mm2.empty();
      row.push_back(known ? Cell{to_w_per_m2(each.derivative_w_per_mm2[i])} : Cell{});
      row.push_back(known ? Cell{to_w_per_m2(each.derivative_noise_w_per_mm2[i])} : Cell{});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

WrittenFiles write_sensitivity(const design::Scene& scene, const design::Sensitivity& sensitivity,
                               const std::filesystem::path& path) {
  RunFolder folder(path);
  folder.text("scene.toml", design::scene_text(scene));
  folder.text("sensitivity.json", json_text(sensitivity_json(scene, sensitivity)));
  folder.table("sensitivity.csv", tolerance_table(sensitivity));
  folder.table("derivatives.csv", derivative_table(scene, sensitivity));
  Page page = page_of(scene, "sensitivity");
  page.subtitle = budget_sentence(sensitivity);
  page.facts = {
      {"Allowed change of the field", fmt::format("{:.3g}", sensitivity.allowed_rel)},
      {"Root mean square of the field", fmt::format("{:.5g} {}", to_w_per_m2(sensitivity.field_rms_w_per_mm2),
                                                    printed(irradiance_unit(scene.source.quantity)))},
      {"Time", fmt::format("{:.1f} s, {} photons", sensitivity.seconds, sensitivity.photons)}};
  PageSection tolerances{"Tolerances", remarks(sensitivity), {}, {{"", tolerance_table(sensitivity)}}, {}};
  for (const auto& each : sensitivity.parameters)
    tolerances.facts.emplace_back(each.deviation.name, each.deviation.meaning);
  const auto drawn = folder.draw_all(figures(scene, sensitivity));
  page.sections = {std::move(tolerances),
                   {"What changes where", {}, {}, {}, picked(drawn)},
                   again_section(scene, "sensitivity")};
  folder.text("report.html", html_page(page));
  return folder.take();
}

}  // namespace catoptric::report
