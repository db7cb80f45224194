#include "report/verdict.h"

#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "design/constraints.h"
#include "design/metrics.h"
#include "report/page_tables.h"
#include "report/result_json.h"

namespace catoptric::report {
namespace {

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + printed(unit);
}

std::string objective_text(const design::Scene& scene, const design::Figure& figure) {
  return figure_text(figure, design::objective_unit(scene));
}

/// Two digits, written out where that is short.
std::string bias_text(double bias) {
  const double size = std::abs(bias);
  return size >= 100 && size < 1e5 ? fmt::format("{:+.0f}", bias) : fmt::format("{:+.2g}", bias);
}

/// RMSE stands for the words that the others are.
std::string metric_words(const design::Scene& scene) {
  if (scene.search.metric != design::Metric::rmse)
    return "its " + design::objective_name(scene.search.metric);
  return fmt::format("the root mean square error of its {}", irradiance_name(scene.source.quantity));
}

/// How the search ended, as a judgement of the mirror.
std::string ending_words(const design::Scene& scene, const std::string& outcome) {
  if (outcome == "converged")
    return scene.search.method == "none" ? "Nothing was searched" : "The search converged";
  if (outcome == "unsatisfied") return "The constraints are broken: this mirror is not what was asked for";
  if (outcome == "interrupted") return "The search was interrupted: this is the best mirror so far";
  return "The search did not converge: a better mirror may be found";
}

std::string constraint_words(const design::Judged& judged, LengthUnit unit) {
  if (judged.constraints.empty() || !(design::violation(judged.constraints) > 0)) return {};
  return " " + design::sentence(judged.constraints, unit);
}

std::string accuracy_words(const design::Judgement& judgement) {
  if (!judgement.accuracy || judgement.accuracy->proven) return {};
  return " The accuracy asked for is not proven.";
}

std::string objective_name_and_value(const StudyRow& row) {
  const design::Judged& judged = row.designed ? row.designed->best : row.simulated->mirror;
  return design::objective_name(row.scene->search.metric) + " " +
         objective_text(*row.scene, judged.judgement.objective);
}

}  // namespace

std::string figure_text(const design::Figure& figure, const std::string& unit) {
  return fmt::format("{} (bias {})", with_unit(measured_text(figure.value, figure.noise), unit),
                     with_unit(bias_text(figure.bias), unit));
}

std::string verdict(const design::Scene& scene, const design::DesignResult& result) {
  const design::Judgement& judgement = result.best.judgement;
  return fmt::format("{}. With the mirror found {} is {}; with the start it was {}.{}{}",
                     ending_words(scene, outcome_word(result)), metric_words(scene),
                     objective_text(scene, judgement.objective),
                     objective_text(scene, result.start.judgement.objective),
                     constraint_words(result.best, scene.unit), accuracy_words(judgement));
}

std::string verdict(const design::Scene& scene, const design::SimulationResult& result) {
  const design::Judgement& judgement = result.mirror.judgement;
  const std::string rest = constraint_words(result.mirror, scene.unit) + accuracy_words(judgement);
  if (judgement.has_objective)
    return fmt::format("The scene as it stands: {} against what is wanted is {}.{}", metric_words(scene),
                       objective_text(scene, judgement.objective), rest);
  const design::Figure& average = judgement.field.average_w_per_mm2;
  return fmt::format(
      "The scene as it stands: {} on the near field is {} on average. Nothing is wanted there.{}",
      irradiance_name(scene.source.quantity),
      with_unit(measured_text(to_w_per_m2(average.value), to_w_per_m2(average.noise)),
                std::string(irradiance_unit(scene.source.quantity))),
      rest);
}

std::string verdict(const std::vector<StudyRow>& rows) {
  std::size_t failed = 0, converged = 0, designs = 0;
  const StudyRow* best = nullptr;
  const auto objective = [](const StudyRow& row) {
    return (row.designed ? row.designed->best : row.simulated->mirror).judgement.objective.value;
  };
  for (const StudyRow& row : rows) {
    failed += !row.error.empty();
    designs += row.designed.has_value();
    converged += row.designed && outcome_word(*row.designed) == "converged";
    if (!row.designed && !row.simulated) continue;
    const design::Judged& judged = row.designed ? row.designed->best : row.simulated->mirror;
    if (!judged.judgement.has_objective) continue;
    const bool comparable = !best || best->scene->search.metric == row.scene->search.metric;
    if (comparable && (!best || objective(row) < objective(*best))) best = &row;
  }
  std::string text = fmt::format("{} runs", rows.size());
  if (designs > 0) text += fmt::format(", {} of {} designs converged", converged, designs);
  if (failed > 0) text += fmt::format(", {} failed", failed);
  if (best) text += fmt::format(". The best is run {}: {}", best->run.name, objective_name_and_value(*best));
  return text + ".";
}

}  // namespace catoptric::report
