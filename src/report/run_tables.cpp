#include "report/run_tables.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "design/constraints.h"
#include "design/metrics.h"
#include "report/result_json.h"

namespace catoptric::report {
namespace {

/// The metrics besides the one that is searched.
std::vector<design::MetricFigure> others(const design::Scene& scene, const design::Judgement& judgement) {
  std::vector<design::MetricFigure> list;
  for (const design::MetricFigure& each : judgement.metrics)
    if (each.metric != scene.search.metric || more_is_better(each.metric)) list.push_back(each);
  return list;
}

/// A variable by its name; nothing when the mirror's design vector has no such one.
Cell variable_of(const design::Judged& judged, const std::string& name) {
  const auto found = std::find(judged.names.begin(), judged.names.end(), name);
  if (found == judged.names.end()) return {};
  return judged.variables[static_cast<std::size_t>(found - judged.names.begin())];
}

/// A named figure of a run, for the study's table; nothing when the run has no such figure.
Cell figure(const StudyRow& row, const std::string& name) {
  if (!row.designed && !row.simulated) return {};
  const design::Judged& judged = row.designed ? row.designed->best : row.simulated->mirror;
  const design::Figure& objective = judged.judgement.objective;
  if (const Cell value = variable_of(judged, name); value.index() != 0) return value;
  if (judged.judgement.has_objective) {
    if (name == "rmse" || name == "objective") return objective.value;
    if (name == "noise") return objective.noise;
    if (name == "bias") return objective.bias;
  }
  if (name == "photons") return static_cast<long long>(judged.judgement.photons);
  if (name == "kernel_radius") return row.scene->to_scene_unit(judged.judgement.kernel_radius_mm);
  if (name == "seconds") return row.designed ? row.designed->seconds : row.simulated->seconds;
  if (!row.designed) return {};
  if (name == "k") return static_cast<long long>(row.designed->search.successes);
  if (name == "iterations") return static_cast<long long>(row.designed->search.iterations);
  if (name == "evaluations") return static_cast<long long>(row.designed->search.evaluations);
  return {};
}

Cell reference(const StudyRow& row, const std::string& name) {
  for (const auto& [key, value] : row.run.reference)
    if (key == name) return value;
  return {};
}

bool add_once(std::vector<std::string>& list, const std::string& name) {
  if (std::find(list.begin(), list.end(), name) != list.end()) return false;
  list.push_back(name);
  return true;
}

}  // namespace

Table irradiance_table(const design::Scene& scene, const design::Target& target,
                       const design::Judgement& judgement) {
  const std::string length(symbol(scene.unit)), irradiance(irradiance_unit(scene.source.quantity));
  Table table{{{"x", length},
               {"y", length},
               {"z", length},
               {"target", irradiance},
               {"direct", irradiance},
               {"reflected", irradiance},
               {"total", irradiance},
               {"noise", irradiance}},
              {}};
  if (!scene.fields.empty()) table.columns.push_back({"surface", ""});
  for (std::size_t i = 0; i < target.samples.size(); ++i) {
    const Vector3& point_mm = target.samples[i].point_mm;
    table.rows.push_back(
        {scene.to_scene_unit(point_mm.x()), scene.to_scene_unit(point_mm.y()),
         scene.to_scene_unit(point_mm.z()),
         judgement.has_objective ? Cell{to_w_per_m2(target.irradiance_w_per_mm2[i])} : Cell{},
         to_w_per_m2(judgement.direct[i]), to_w_per_m2(judgement.reflected[i]),
         to_w_per_m2(judgement.direct[i] + judgement.reflected[i]), to_w_per_m2(judgement.noise[i])});
    const std::size_t field = target.samples[i].field;
    if (!scene.fields.empty())
      table.rows.back().push_back(field == 0 ? std::string("near_field") : scene.fields[field - 1].name);
  }
  return table;
}

Table generatrix_table(const design::Scene& scene,
                       const std::vector<std::pair<std::string, Profile>>& curves) {
  const std::string length(symbol(scene.unit));
  Table table{{{"curve", ""}, {"parameter", ""}, {"r", length}, {"z", length}}, {}};
  constexpr int intervals = 200;
  for (const auto& [label, profile] : curves)
    for (int i = 0; i <= intervals; ++i) {
      const double share = static_cast<double>(i) / intervals;
      const double u = (1 - share) * profile.first_parameter() + share * profile.last_parameter();
      const MeridianPoint point = profile.at(u);
      table.rows.push_back({label, u, scene.to_scene_unit(point.r_mm), scene.to_scene_unit(point.z_mm)});
    }
  return table;
}

Table convergence_table(const design::Scene& scene, const design::DesignResult& result) {
  Table table{{{"k", ""},
               {"iteration", ""},
               {"evaluations", ""},
               {"step", ""},
               {"move", ""},
               {"value", design::objective_unit(scene)}},
              {}};
  const std::vector<std::string>& names = result.best.names;
  for (const std::string& name : names)
    table.columns.push_back({name, design::unit_of_variable(name, scene.unit)});
  for (const optim::Iterate& each : result.search.history) {
    std::vector<Cell> row{static_cast<long long>(each.k), static_cast<long long>(each.iteration),
                          static_cast<long long>(each.evaluations), each.step, each.move};
    // that of a mirror that breaks constraints is a rank, not a figure
    each.value < design::infeasible_floor ? row.emplace_back(each.value) : row.emplace_back(std::monostate{});
    const bool alike = each.x.size() == names.size();  // before a refinement there were other variables
    for (std::size_t i = 0; i < names.size(); ++i)
      alike ? row.emplace_back(each.x[i]) : row.emplace_back(std::monostate{});
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table landscape_table(const design::Scene& scene, const design::Landscape& landscape) {
  Table table;
  for (const std::string& name : landscape.names)
    table.columns.push_back({name, design::unit_of_variable(name, scene.unit)});
  table.columns.push_back({"value", design::objective_unit(scene)});
  std::size_t next = 0;
  for (double a : landscape.axes[0]) {
    if (landscape.axes.size() == 1) {
      table.rows.push_back({a, landscape.objective[next++]});
      continue;
    }
    for (double b : landscape.axes[1]) table.rows.push_back({a, b, landscape.objective[next++]});
  }
  return table;
}

Table paths_table(const design::Scene& scene, const design::Landscape& landscape) {
  Table table{{{"path", ""}}, {}};
  for (const std::string& name : landscape.names)
    table.columns.push_back({name, design::unit_of_variable(name, scene.unit)});
  table.columns.push_back({"value", design::objective_unit(scene)});
  for (const design::SearchPath& path : landscape.paths)
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      std::vector<Cell> row{path.name};
      for (const double x : path.points[i]) row.emplace_back(x);
      path.values.empty() ? row.emplace_back(std::monostate{}) : row.emplace_back(path.values[i]);
      table.rows.push_back(std::move(row));
    }
  return table;
}

Table summary_table(const design::Scene& scene, const design::DesignResult& result) {
  Table table{{{"figure", ""}, {"unit", ""}, {"start", ""}, {"result", ""}}, {}};
  const design::Judged &start = result.start, &best = result.best;
  const bool alike = start.names == best.names;  // not after a refinement
  for (std::size_t i = 0; i < best.names.size(); ++i)
    table.rows.push_back({best.names[i], design::unit_of_variable(best.names[i], scene.unit),
                          alike ? Cell{start.variables[i]} : Cell{}, best.variables[i]});
  const design::Figure &before = result.start.judgement.objective, &after = result.best.judgement.objective;
  const std::string metric = design::objective_name(scene.search.metric),
                    unit = design::objective_unit(scene);
  table.rows.push_back({metric, unit, before.value, after.value});
  table.rows.push_back({"  its noise (1 sigma)", unit, before.noise, after.noise});
  table.rows.push_back({"  its bias", unit, before.bias, after.bias});
  const auto first = others(scene, result.start.judgement), last = others(scene, result.best.judgement);
  for (std::size_t i = 0; i < std::min(first.size(), last.size()); ++i) {
    const std::string other(name(last[i].metric)),
        other_unit = design::unit(last[i].metric, scene.source.quantity);
    table.rows.push_back({other, other_unit, first[i].figure.value, last[i].figure.value});
    table.rows.push_back({"  its noise (1 sigma)", other_unit, first[i].figure.noise, last[i].figure.noise});
  }
  table.rows.push_back({"kernel radius, mean", std::string(symbol(scene.unit)),
                        scene.to_scene_unit(result.start.judgement.kernel_radius_mm),
                        scene.to_scene_unit(result.best.judgement.kernel_radius_mm)});
  return table;
}

Table simulation_table(const design::Scene& scene, const design::SimulationResult& result) {
  const design::Judgement& judgement = result.mirror.judgement;
  Table table{{{"figure", ""}, {"unit", ""}, {"value", ""}}, {}};
  const design::Judged& mirror = result.mirror;
  for (std::size_t i = 0; i < mirror.names.size(); ++i)
    table.rows.push_back(
        {mirror.names[i], design::unit_of_variable(mirror.names[i], scene.unit), mirror.variables[i]});
  if (judgement.has_objective) {
    const std::string metric = design::objective_name(scene.search.metric),
                      unit = design::objective_unit(scene);
    table.rows.push_back({metric, unit, judgement.objective.value});
    table.rows.push_back({"  its noise (1 sigma)", unit, judgement.objective.noise});
    table.rows.push_back({"  its bias", unit, judgement.objective.bias});
  }
  for (const auto& [metric, figure] : others(scene, judgement)) {
    table.rows.push_back(
        {std::string(name(metric)), design::unit(metric, scene.source.quantity), figure.value});
    table.rows.push_back(
        {"  its noise (1 sigma)", design::unit(metric, scene.source.quantity), figure.noise});
  }
  table.rows.push_back({"kernel radius, mean", std::string(symbol(scene.unit)),
                        scene.to_scene_unit(judgement.kernel_radius_mm)});
  const std::string irradiance(irradiance_unit(scene.source.quantity));
  table.rows.push_back(
      {"noise of one evaluation, rms", irradiance, to_w_per_m2(judgement.field_noise_w_per_mm2)});
  table.rows.push_back(
      {"kernel bias of the field, rms", irradiance, to_w_per_m2(judgement.field_bias_w_per_mm2)});
  if (judgement.accuracy) {
    table.rows.push_back({"accuracy asked for, relative", "", judgement.accuracy->asked_rel});
    table.rows.push_back({"relative error, at most (95 %)", "", judgement.accuracy->error95_rel});
  }
  table.rows.push_back({"model", "", std::string(name(judgement.rung))});
  const std::string flux(flux_unit(scene.source.quantity));
  table.rows.push_back({"source", flux, result.mirror.source.power_w});
  if (judgement.rung == sim::Rung::tubes) return table;  // tubes keep no ledger
  table.rows.push_back({"emitted towards the mirror", flux, judgement.energy.emitted_w});
  table.rows.push_back({"  missed it", flux, judgement.energy.missed_w});
  table.rows.push_back({"  absorbed by it", flux, judgement.energy.absorbed_w});
  if (scene.surroundings)
    table.rows.push_back({"  stopped by objects about it", flux, judgement.energy.stopped_w});
  table.rows.push_back({"  received by the near field", flux, judgement.energy.received_w});
  table.rows.push_back({"  escaped past the near field", flux, judgement.energy.escaped_w});
  return table;
}

Table constraint_table(const design::Scene& scene, const std::vector<design::ConstraintState>& states) {
  Table table{
      {{"constraint", ""}, {"unit", ""}, {"limit", ""}, {"value", ""}, {"violation", ""}, {"found", ""}}, {}};
  for (const design::ConstraintState& state : states) {
    const auto number = [&](double value) { return Cell{shown(state, value, scene.unit)}; };
    table.rows.push_back({state.name + (state.at_least ? " >=" : " <="), unit_of(state, scene.unit),
                          number(state.limit), number(state.value), number(state.violation),
                          std::string(state.certified ? "certified" : "on many points")});
  }
  return table;
}

Table study_table(const std::vector<StudyRow>& rows) {
  std::vector<std::string> names, references;
  for (const StudyRow& row : rows) {
    if (row.scene)
      for (const auto& variable : row.scene->variables) add_once(names, variable.name);
    for (const auto& [key, value] : row.run.reference) add_once(references, key);
  }
  for (const char* figure_name :
       {"rmse", "noise", "bias", "kernel_radius", "photons", "k", "iterations", "evaluations", "seconds"})
    add_once(names, figure_name);
  Table table{{{"run", ""}, {"outcome", ""}}, {}};
  const design::Scene* first = nullptr;
  for (const StudyRow& row : rows)
    if (!first && row.scene) first = &*row.scene;
  for (const std::string& name : names) {
    std::string unit;
    if (first && (name == "rmse" || name == "noise" || name == "bias")) unit = design::objective_unit(*first);
    if (first && (name == "kernel_radius" || name[0] == 'r' || name[0] == 'z') && name != "rmse")
      unit = std::string(symbol(first->unit));
    if (name == "seconds") unit = "s";
    table.columns.push_back({name, unit});
    if (std::find(references.begin(), references.end(), name) != references.end())
      table.columns.push_back({name + " ref", unit});
  }
  for (const StudyRow& row : rows) {
    const std::string outcome = row.designed    ? outcome_word(*row.designed)
                                : row.simulated ? "simulated"
                                                : row.error;
    std::vector<Cell> cells{row.run.name, outcome};
    for (const std::string& name : names) {
      cells.push_back(figure(row, name));
      if (std::find(references.begin(), references.end(), name) != references.end())
        cells.push_back(reference(row, name));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace catoptric::report
