#include "report/result_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "design/constraints.h"
#include "design/metrics.h"
#include "report/field_report.h"

namespace catoptric::report {
namespace {

using Json = nlohmann::ordered_json;

Json variables_json(const design::Judged& judged) {
  Json json = Json::object();
  for (std::size_t i = 0; i < judged.variables.size(); ++i) json[judged.names[i]] = judged.variables[i];
  return json;
}

/// An objective; null where it is the rank of a mirror that breaks constraints and no figure.
Json search_value_json(double value) {
  return value < design::infeasible_floor ? Json(value) : Json(nullptr);
}

/// What each search of a refined design had and reached; empty where nothing was refined.
Json stages_json(const std::vector<design::RefinementStage>& stages) {
  Json json = Json::array();
  if (stages.size() < 2) return json;
  for (const design::RefinementStage& stage : stages)
    json.push_back({{"step", stage.step},
                    {"points", stage.points},
                    {"variables", stage.variables},
                    {"evaluations", stage.evaluations},
                    {"search_value", search_value_json(stage.value)}});
  return json;
}

std::string json_unit(design::Metric metric, LightQuantity quantity) {
  const std::string unit = design::unit(metric, quantity);
  return unit.empty() ? "1" : unit;
}

/// That a metric can be: shares and evenness end at 1.
double greatest(design::Metric metric) { return design::more_is_better(metric) ? 1 : HUGE_VAL; }

/// Every metric that has a value, whatever is searched.
Json metrics_json(const design::Judgement& judgement, LightQuantity quantity) {
  Json json = Json::object();
  for (const auto& [metric, figure] : judgement.metrics)
    json[std::string(name(metric))] = {{"value", figure.value},
                                       {"unit", json_unit(metric, quantity)},
                                       {"noise", figure.noise},
                                       {"bias", figure.bias},
                                       {"interval95", interval_json(figure, greatest(metric))}};
  return json;
}

Json constraints_json(const design::Scene& scene, const std::vector<design::ConstraintState>& states) {
  Json list = Json::array();
  for (const design::ConstraintState& state : states)
    list.push_back({{"name", state.name},
                    {"value", shown(state, state.value, scene.unit)},
                    {state.at_least ? "at_least" : "at_most", shown(state, state.limit, scene.unit)},
                    {"violation", shown(state, state.violation, scene.unit)},
                    {"unit", unit_of(state, scene.unit)},
                    {"met", state.violation == 0},
                    {"certified", state.certified}});
  return list;
}

Json objective_json(const design::Scene& scene, const design::Judgement& judgement) {
  if (!judgement.has_objective) return nullptr;
  Json json = {{"metric", std::string(name(scene.search.metric))},
               {"value", judgement.objective.value},
               {"minimised", design::objective_name(scene.search.metric)},
               {"unit", json_unit(scene.search.metric, scene.source.quantity)},
               {"noise", judgement.objective.noise},
               {"bias", judgement.objective.bias},
               {"interval95", interval_json(judgement.objective, greatest(scene.search.metric))},
               {"kernel_radius", scene.to_scene_unit(judgement.kernel_radius_mm)},
               {"kernel_radius_unit", std::string(symbol(scene.unit))}};
  if (scene.model.estimate.neighbours) json["neighbours"] = *scene.model.estimate.neighbours;
  json["kernel"] = std::string(sim::name(scene.model.estimate.kernel));
  json["photons"] = judgement.photons;
  json["replicates"] = judgement.replicates;
  json["samples"] = judgement.reflected.size();
  json["field_unit"] = irradiance_unit(scene.source.quantity);
  json["field_noise"] = to_w_per_m2(judgement.field_noise_w_per_mm2);
  json["field_bias"] = to_w_per_m2(judgement.field_bias_w_per_mm2);
  json["model"] = std::string(name(judgement.rung));
  return json;
}

Json judged_json(const design::Scene& scene, const design::Judged& judged) {
  return {{"variables", variables_json(judged)},
          {"objective", objective_json(scene, judged.judgement)},
          {"metrics", metrics_json(judged.judgement, scene.source.quantity)},
          {"near_field", field_json(scene, judged.judgement)},
          {"constraints", constraints_json(scene, judged.constraints)}};
}

Json energy_json(const design::SourceSpec& source, const sim::EnergyLedger& energy) {
  return {{"unit", flux_unit(source.quantity)}, {"source", source.power_w},
          {"towards_mirror", energy.emitted_w}, {"missed_mirror", energy.missed_w},
          {"absorbed", energy.absorbed_w},      {"stopped_by_objects", energy.stopped_w},
          {"received", energy.received_w},      {"escaped", energy.escaped_w},
          {"cut_off", energy.cut_off_w}};
}

Json reflector_json(const design::Scene& scene, const Profile& profile) {
  Json points = Json::array(), weights = Json::array();
  for (const ControlPoint& point : profile.points()) {
    points.push_back({scene.to_scene_unit(point.r_mm), scene.to_scene_unit(point.z_mm)});
    weights.push_back(point.weight);
  }
  return {{"degree", profile.degree()},
          {"knots", profile.knots()},
          {"points", points},
          {"weights", weights},
          {"unit", std::string(symbol(scene.unit))},
          {"rim_radius", scene.to_scene_unit(profile.at(profile.last_parameter()).r_mm)},
          {"depth", scene.to_scene_unit(profile.z_max_mm() - profile.z_min_mm())},
          {"area_mm2", profile.area_mm2()}};
}

/// How an accuracy was reached; null where none was asked for. Errors are relative to the field's root mean
/// square.
Json accuracy_json(const design::Judgement& judgement) {
  if (!judgement.accuracy) return nullptr;
  const design::AccuracyReport& report = *judgement.accuracy;
  Json stages = Json::array();
  for (const sim::AccuracyStage& stage : report.stages)
    stages.push_back({{"photons", stage.photons}, {"error95", stage.error95_rel}});
  return {{"asked", report.asked_rel},     {"proven", report.proven},
          {"error95", report.error95_rel}, {"noise", report.noise_rel},
          {"bias", report.bias_rel},       {"model", std::string(name(judgement.rung))},
          {"order", report.order},         {"photons_spent", report.spent_photons},
          {"rays", report.rays},           {"stages", stages},
          {"sentence", report.sentence}};
}

Json run_json(const design::Scene& scene, sim::Rung rung) {
  return {{"model", std::string(name(rung))},
          {"intersector", std::string(name(scene.model.engine))},
          {"sampler", scene.model.photons.sampler == sim::Sampler::sobol ? "sobol" : "random"},
          {"seed", scene.seed},
          {"version", version()}};
}

}  // namespace

std::string version() { return CATOPTRIC_VERSION " (" CATOPTRIC_COMMIT ")"; }

std::string outcome_word(optim::Ending ending) {
  switch (ending) {
    case optim::Ending::converged:
    case optim::Ending::target_reached:
      return "converged";
    case optim::Ending::stopped:
      return "interrupted";
    default:
      return "unconverged";
  }
}

std::string outcome_word(const design::DesignResult& result) {
  const bool broken = design::violation(result.best.constraints) > 0;
  const std::string word = outcome_word(result.search.ending);
  return broken && word == "converged" ? "unsatisfied" : word;
}

Json result_json(const design::Scene& scene, const design::DesignResult& result) {
  const design::Judgement& judgement = result.best.judgement;
  Json json = {{"title", scene.title},
               {"command", "design"},
               {"outcome", outcome_word(result)},
               {"sentence", result.search.sentence},
               {"unit", std::string(symbol(scene.unit))}};
  json.update(judged_json(scene, result.best));
  json["search_value"] = search_value_json(result.search.value);
  json["stages"] = stages_json(result.stages);
  json["constraints_sentence"] = design::sentence(result.best.constraints, scene.unit);
  json["start"] = judged_json(scene, result.start);
  json["counts"] = {{"iterations", result.search.iterations},   {"successes", result.search.successes},
                    {"evaluations", result.search.evaluations}, {"cache_hits", result.search.cache_hits},
                    {"restarts", result.search.restarts},       {"photons", result.photons}};
  json["seconds"] = result.seconds;
  json.update(run_json(scene, result.plan.rung));
  json["seconds_search"] = result.search_seconds;
  json["verdict_model"] = std::string(name(judgement.rung));
  json["accuracy"] = accuracy_json(judgement);
  json["energy"] = energy_json(result.best.source, judgement.energy);
  json["reflector"] = reflector_json(scene, result.best.profile);
  json["profile_notes"] = scene.profile_notes;
  json["target_notes"] = scene.target.notes;
  return json;
}

Json result_json(const design::Scene& scene, const design::SimulationResult& result) {
  Json json = {{"title", scene.title},
               {"command", "simulate"},
               {"outcome", "simulated"},
               {"unit", std::string(symbol(scene.unit))}};
  json.update(judged_json(scene, result.mirror));
  json["counts"] = {{"photons", result.photons}};
  json["seconds"] = result.seconds;
  json.update(run_json(scene, result.mirror.judgement.rung));
  json["accuracy"] = accuracy_json(result.mirror.judgement);
  json["energy"] = energy_json(result.mirror.source, result.mirror.judgement.energy);
  json["reflector"] = reflector_json(scene, result.mirror.profile);
  json["profile_notes"] = scene.profile_notes;
  json["target_notes"] = scene.target.notes;
  return json;
}

std::string json_text(const Json& value) { return value.dump(2) + "\n"; }

}  // namespace catoptric::report
