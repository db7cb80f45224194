#include "design/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/ordered_sum.h"
#include "design/evaluator.h"
#include "design/far_field.h"

namespace catoptric::design {
namespace {

constexpr std::array metrics{
    Metric::rmse,      Metric::relative_rmse, Metric::enclosed_flux,           Metric::uniformity,
    Metric::diversity, Metric::efficiency,    Metric::relative_intensity_rmse, Metric::intensity_rmse};

/// The target at the level that comes nearest to the field: the least squares' one.
std::vector<double> fitted(std::span<const double> total, const Target& target) {
  std::vector<double> both, own;
  for (std::size_t i = 0; i < total.size(); ++i) {
    const double wanted = target.irradiance_w_per_mm2[i];
    const double weight = target.weights.empty() ? 1.0 : target.weights[i];
    both.push_back(weight * wanted * total[i]);
    own.push_back(weight * wanted * wanted);
  }
  const double square = ordered_sum(own), level = square > 0 ? ordered_sum(both) / square : 0.0;
  std::vector<double> wanted(target.irradiance_w_per_mm2);
  for (double& value : wanted) value *= level;
  return wanted;
}

bool is_relative(Metric metric) {
  return metric == Metric::relative_rmse || metric == Metric::relative_intensity_rmse;
}

/// With a free scale a relative error refers to the field itself, so that it lies between 0 and 1.
std::optional<double> error(Metric metric, const Scene& scene, std::span<const double> total,
                            const Target& target) {
  const std::vector<double> wanted =
      scene.target.free_scale ? fitted(total, target) : target.irradiance_w_per_mm2;
  const double rmse = root_mean_square_error(total, wanted, target.weights);
  if (metric == Metric::rmse) return to_w_per_m2(rmse);
  if (metric == Metric::intensity_rmse) return rmse;
  if (!(root_mean_square(target.irradiance_w_per_mm2, target.weights) > 0)) return std::nullopt;
  if (!scene.target.free_scale) return rmse / root_mean_square(wanted, target.weights);
  const double field = root_mean_square(total, target.weights);  // at best fit its target is no larger
  return field > 0 ? rmse / field : 1.0;
}

/// Least irradiance on the lit part, over its mean or over the greatest.
std::optional<double> evenness(Metric metric, std::span<const double> total, const Target& target) {
  std::vector<double> lit, weights;
  for (std::size_t i = 0; i < total.size(); ++i) {
    const double weight = target.weights.empty() ? 1.0 : target.weights[i];
    if (!target.lit[i] || weight == 0) continue;
    lit.push_back(total[i]);
    weights.push_back(weight);
  }
  if (lit.empty()) return std::nullopt;
  const auto [least, greatest] = std::minmax_element(lit.begin(), lit.end());
  const double low = *least, high = *greatest;
  if (metric == Metric::diversity) return high > 0 ? low / high : 0.0;
  for (std::size_t i = 0; i < lit.size(); ++i) lit[i] *= weights[i];
  const double mean = ordered_sum(lit) / ordered_sum(weights);
  return mean > 0 ? low / mean : 0.0;
}

std::optional<double> flux_share(const Scene& scene, std::span<const double> total, const Target& target,
                                 const std::vector<char>& counted) {
  const bool alike = target.areas_mm2.empty();
  std::vector<double> values;
  for (std::size_t i = 0; i < total.size(); ++i)
    if (counted[i]) values.push_back(total[i] * (alike ? 1.0 : target.areas_mm2[i]));
  if (values.empty()) return std::nullopt;
  const double share =
      alike ? scene.near_field.area_mm2() / static_cast<double>(total.size()) : 1.0;  // of each
  return ordered_sum(values) * share / scene.source.power_w;
}

}  // namespace

std::span<const Metric> all_metrics() { return metrics; }

bool is_of_intensity(Metric metric) {
  return metric == Metric::intensity_rmse || metric == Metric::relative_intensity_rmse;
}

bool more_is_better(Metric metric) {
  return metric != Metric::rmse && metric != Metric::relative_rmse && !is_of_intensity(metric);
}

std::string objective_name(Metric metric) {
  return (more_is_better(metric) ? "1 - " : "") + std::string(name(metric));
}

std::string unit(Metric metric, LightQuantity quantity) {
  if (metric == Metric::rmse) return std::string(irradiance_unit(quantity));
  return metric == Metric::intensity_rmse ? std::string(intensity_unit(quantity)) : "";
}

std::string objective_unit(const Scene& scene) { return unit(scene.search.metric, scene.source.quantity); }

std::optional<double> metric_value(Metric metric, const Scene& scene, std::span<const double> total_w_per_mm2,
                                   const Target& target) {
  if (target.irradiance_w_per_mm2.empty()) return std::nullopt;
  if (target.intensities != is_of_intensity(metric)) return std::nullopt;
  switch (metric) {
    case Metric::rmse:
    case Metric::relative_rmse:
    case Metric::intensity_rmse:
    case Metric::relative_intensity_rmse:
      return error(metric, scene, total_w_per_mm2, target);
    case Metric::enclosed_flux:
      return flux_share(scene, total_w_per_mm2, target, target.within_reach);
    case Metric::uniformity:
    case Metric::diversity:
      return evenness(metric, total_w_per_mm2, target);
    case Metric::efficiency:
      break;
  }
  return flux_share(scene, total_w_per_mm2, target, target.lit);
}

double as_objective(Metric metric, double value) { return more_is_better(metric) ? 1 - value : value; }

double objective(const Scene& scene, std::span<const double> total_w_per_mm2, const Target& target) {
  const Metric metric = scene.search.metric;
  return as_objective(metric, *metric_value(metric, scene, total_w_per_mm2, target));
}

void require_metric(const Scene& scene, const Target& target) {
  const Metric metric = scene.search.metric;
  if (scene.target.free_scale && metric == Metric::rmse)
    throw scene.settings.error("search.metric", "says nothing about a target of free scale",
                               "the darkest field fits best when the level is free",
                               "search.metric = \"relative-rmse\"");
  if (is_of_intensity(metric)) {
    if (!target.far)
      throw scene.settings.error("search.metric", "no intensity is wanted", "it compares with a table",
                                 "target.intensity_file");
    if (!scene.search.kernels_mm.empty())
      throw scene.settings.error("search.kernels", "has no effect on intensities", "these are lengths",
                                 "a larger target.intensity_resolution");
    if (scene.target.free_intensity && metric == Metric::intensity_rmse)
      throw scene.settings.error("search.metric", "says nothing about an intensity of free scale",
                                 "the darkest lamp fits best when the level is free",
                                 "search.metric = \"relative-intensity-rmse\"");
    if (!metric_value(metric, target.far->scene, target.far->target.irradiance_w_per_mm2, target.far->target))
      throw scene.settings.error("search.metric", "the intensity wanted is 0 everywhere",
                                 "relative-intensity-rmse divides by its root mean square",
                                 "search.metric = \"intensity-rmse\"");
    return;
  }
  // the target itself stands for the field: the relative error of a dark one has no meaning
  if (!metric_value(metric, scene, target.irradiance_w_per_mm2, target))
    throw scene.settings.error(
        "search.metric", "the target is dark everywhere",
        is_relative(metric) ? "relative-rmse divides by the target's root mean square"
                            : std::string(name(metric)) + " looks at its lit part, at the samples",
        is_relative(metric) ? "search.metric = \"rmse\"" : "near_field.samples, or the target");
}

}  // namespace catoptric::design
