#include "report/page_tables.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "base/units.h"
#include "design/metrics.h"

namespace catoptric::report {
namespace {

constexpr std::size_t most_rows = 60, first_rows = 10;

/// Decimal place of the last digit that a value with this noise has.
int last_place(double noise) { return static_cast<int>(std::floor(std::log10(noise))) - 1; }

bool is_noisy(double noise) { return noise > 0 && std::isfinite(noise); }

class FigureRows {
 public:
  explicit FigureRows(bool has_start) : has_start_(has_start) {
    table.columns = {{"figure", ""}, {"unit", ""}};
    if (has_start) table.columns.push_back({"start", ""});
    table.columns.push_back({has_start ? "result" : "value", ""});
    table.columns.push_back({"noise (1 sigma)", "", 2});
    table.columns.push_back({"bias", "", 2});
  }

  void add(const std::string& name, const std::string& unit, const Cell& start, const Cell& value,
           const Cell& noise = {}, const Cell& bias = {}) {
    std::vector<Cell> row{name, printed(unit)};
    if (has_start_) row.push_back(start);
    row.insert(row.end(), {value, noise, bias});
    table.rows.push_back(std::move(row));
  }

  void add(const std::string& name, const std::string& unit, const design::Figure* start,
           const design::Figure& figure) {
    add(name, unit, start ? Cell{rounded_to_noise(start->value, start->noise)} : Cell{},
        rounded_to_noise(figure.value, figure.noise), figure.noise, figure.bias);
  }

  Table table;

 private:
  bool has_start_;
};

void add_variables(FigureRows& rows, const design::Scene& scene, const design::Judged& found,
                   const design::Judged* start) {
  const bool alike = start && start->names == found.names;  // not after a refinement
  for (std::size_t i = 0; i < found.names.size(); ++i)
    rows.add(found.names[i], design::unit_of_variable(found.names[i], scene.unit),
             alike ? Cell{start->variables[i]} : Cell{}, found.variables[i]);
}

/// The metrics besides the one that is searched.
bool is_other(const design::Scene& scene, design::Metric metric) {
  return metric != scene.search.metric || design::more_is_better(metric);
}

const design::Figure* same_metric(const design::Judged* start, design::Metric metric) {
  if (!start) return nullptr;
  for (const design::MetricFigure& each : start->judgement.metrics)
    if (each.metric == metric) return &each.figure;
  return nullptr;
}

}  // namespace

double rounded_to_noise(double value, double noise) {
  if (!is_noisy(noise) || !std::isfinite(value)) return value;
  const int place = last_place(noise);
  if (place < -300 || place > 300) return value;
  const std::string digits = place < 0 ? fmt::format("{:.{}f}", value, -place)
                                       : fmt::format("{:.0f}e{}", value / std::pow(10, place), place);
  return std::strtod(digits.c_str(), nullptr);
}

std::string measured_text(double value, double noise) {
  constexpr double least_written_out = 1e-4, greatest_written_out = 1e7;
  const double size = std::abs(value);
  if (!is_noisy(noise)) return fmt::format("{:.4g}", value);
  const int place = last_place(noise);
  if (place >= 0 || size < least_written_out || size > greatest_written_out || place < -9)
    return fmt::format("{:.4g} ± {:.2g}", rounded_to_noise(value, noise), noise);
  return fmt::format("{:.{}f} ± {:.{}f}", value, -place, noise, -place);
}

Table figures_table(const design::Scene& scene, const design::Judged& found, const design::Judged* start) {
  FigureRows rows(start != nullptr);
  add_variables(rows, scene, found, start);
  const design::Judgement& judgement = found.judgement;
  if (judgement.has_objective)
    rows.add(design::objective_name(scene.search.metric), design::objective_unit(scene),
             start ? &start->judgement.objective : nullptr, judgement.objective);
  for (const auto& [metric, figure] : judgement.metrics)
    if (is_other(scene, metric))
      rows.add(std::string(name(metric)), design::unit(metric, scene.source.quantity),
               same_metric(start, metric), figure);
  const auto radius = [&](const design::Judged& judged) {
    return Cell{scene.to_scene_unit(judged.judgement.kernel_radius_mm)};
  };
  rows.add("kernel radius, mean", std::string(symbol(scene.unit)), start ? radius(*start) : Cell{},
           radius(found));
  return std::move(rows.table);
}

Table energy_table(const design::Scene& scene, const design::Judged& judged) {
  Table table{{{"light", ""},
               {"power", std::string(flux_unit(scene.source.quantity)), 5},
               {"share of the source", "%", 4}},
              {}};
  if (scene.source.quantity == LightQuantity::luminous) table.columns[1].name = "flux";
  if (judged.judgement.rung == sim::Rung::tubes) return table;
  const double source = judged.source.power_w;
  const sim::EnergyLedger& energy = judged.judgement.energy;
  const auto add = [&](const char* name, double power_w) {
    table.rows.push_back({std::string(name), power_w, source > 0 ? Cell{100 * power_w / source} : Cell{}});
  };
  add("sent out by the source", source);
  add("emitted towards the mirror", energy.emitted_w);
  add("  missed it", energy.missed_w);
  add("  absorbed by it", energy.absorbed_w);
  if (scene.surroundings) add("  stopped by objects about it", energy.stopped_w);
  add(scene.fields.empty() ? "  received by the near field"
                           : "  received by the near field and further fields",
      energy.received_w);
  add(scene.fields.empty() ? "  escaped past the near field" : "  escaped", energy.escaped_w);
  if (energy.cut_off_w > 0) add("  given up after too many bounces", energy.cut_off_w);
  return table;
}

Table control_point_table(const design::Scene& scene, const Profile& profile) {
  const std::string length(symbol(scene.unit));
  Table points{{{"control point", ""}, {"r", length, 9}, {"z", length, 9}, {"weight", "", 9}}, {}};
  for (std::size_t i = 0; i < profile.points().size(); ++i) {
    const ControlPoint& point = profile.points()[i];
    points.rows.push_back({static_cast<long long>(i), scene.to_scene_unit(point.r_mm),
                           scene.to_scene_unit(point.z_mm), point.weight});
  }
  return points;
}

Table shortened(Table table) {
  if (table.rows.size() <= most_rows) return table;
  const auto begin = table.rows.begin() + first_rows;
  const auto end = table.rows.end() - static_cast<std::ptrdiff_t>(most_rows - first_rows);
  table.rows.erase(begin, end);
  std::vector<Cell> gap(table.columns.size());
  gap.front() = std::string("…");
  table.rows.insert(table.rows.begin() + first_rows, std::move(gap));
  return table;
}

}  // namespace catoptric::report
