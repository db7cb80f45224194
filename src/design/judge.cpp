#include "design/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/ordered_sum.h"
#include "design/evaluator.h"
#include "design/far_field.h"
#include "design/metrics.h"
#include "design/shared_work.h"
#include "design/stage.h"

namespace catoptric::design {
namespace {

double mean(const std::vector<double>& values) {
  return ordered_sum(values) / static_cast<double>(values.size());
}

/// Root of a mean square from which the noise's own share is taken; 0 where noise explains it all.
double debiased_root(double mean_square, double noise_square) {
  return std::sqrt(std::max(0.0, mean_square - noise_square));
}

/// Mean over the samples, each with its weight in the target.
double weighted_mean(const std::vector<double>& values, const Target& target) {
  if (target.weights.empty()) return mean(values);
  std::vector<double> weighted(values);
  for (std::size_t i = 0; i < weighted.size(); ++i) weighted[i] *= target.weights[i];
  return ordered_sum(weighted) / ordered_sum(target.weights);
}

/// The metric that a field without noise and blur would have.
double debiased_value(Metric metric, const Scene& scene, const Target& target, const Spread& sharp,
                      const std::vector<double>& direct) {
  const std::vector<double> total = sum(sharp.mean, direct);
  const double value = *metric_value(metric, scene, total, target);
  if (more_is_better(metric)) return value;
  if (is_of_intensity(metric)) {
    const double rmse = *metric_value(Metric::intensity_rmse, scene, total, target);
    const double clean = debiased_root(rmse * rmse, weighted_mean(sharp.variance_of_mean, target));
    return metric == Metric::intensity_rmse ? clean : rmse > 0 ? value * clean / rmse : 0.0;
  }
  const double rmse = from_w_per_m2(*metric_value(Metric::rmse, scene, total, target));
  const double clean = debiased_root(rmse * rmse, weighted_mean(sharp.variance_of_mean, target));
  return metric == Metric::rmse ? to_w_per_m2(clean) : rmse > 0 ? value * clean / rmse : 0.0;
}

/// How far noise that picks out extremes may move a ratio with the least, among the lit samples.
double ratio_margin(Metric metric, double value, const Spread& fields, const std::vector<double>& direct,
                    const Target& target) {
  Spread counting;
  double average = 0, greatest = 0;
  for (std::size_t i = 0; i < fields.mean.size(); ++i) {
    if (!target.lit[i] || (!target.weights.empty() && target.weights[i] == 0)) continue;  // as the metric
    counting.mean.push_back(direct[i] + fields.mean[i]);
    counting.variance_of_mean.push_back(fields.variance_of_mean[i]);
    average += counting.mean.back();
    greatest = std::max(greatest, counting.mean.back());
  }
  if (!(greatest > 0 && average > 0)) return 0;
  const ExtremesMargin margin = extremes_margin(counting);
  if (metric == Metric::uniformity) return margin.least * static_cast<double>(counting.mean.size()) / average;
  return (margin.least + value * margin.greatest) / greatest;
}

Figure judge_metric(Metric metric, const Scene& scene, const Target& target, const Rows& reflected,
                    const Rows& sharp, const std::vector<double>& direct) {
  const auto of_one = [&](const std::vector<double>& field) {
    return std::vector<double>{*metric_value(metric, scene, sum(direct, field), target)};
  };
  const auto of_all = [&](const Spread& fields) {
    return std::vector<double>{debiased_value(metric, scene, target, fields, direct)};
  };
  Figure figure = figures_of(reflected, sharp, of_one, of_all).front();
  if (figure.half_interval && (metric == Metric::uniformity || metric == Metric::diversity))
    *figure.half_interval += ratio_margin(metric, figure.value, spread(sharp), direct, target);
  return figure;
}

/// The scene with a candidate's source: a share of the power is a share of that source's.
Scene with_source(Scene scene, const Candidate& candidate) {
  scene.source = candidate.source;
  return scene;
}

void take_figure(Judgement& judgement, const Scene& scene, Metric metric, const Figure& figure) {
  judgement.metrics.push_back({metric, figure});
  if (metric != scene.search.metric) return;
  judgement.objective = figure;
  judgement.objective.value = as_objective(metric, figure.value);
  if (more_is_better(metric)) judgement.objective.bias = -figure.bias;
}

/// All metrics, and of them the scene's as the search saw it.
void fill_metrics(Judgement& judgement, const Scene& scene, const Target& target, const Rows& reflected,
                  const Rows& sharp) {
  judgement.has_objective = !target.irradiance_w_per_mm2.empty();
  for (Metric metric : all_metrics()) {
    if (!metric_value(metric, scene, target.irradiance_w_per_mm2, target)) continue;
    // Where the target is blurred alike, it is the blurred field that compares to it; what is said of the
    // field itself is said of the field without blur.
    const Rows& truth = target.through_kernel && !more_is_better(metric) ? reflected : sharp;
    take_figure(judgement, scene, metric,
                judge_metric(metric, scene, target, reflected, truth, judgement.direct));
  }
}

/// What follows from the replicates' fields alone.
void fill_fields(Judgement& judgement, const Rows& reflected, const Rows& sharp) {
  Rows blur(reflected.size());
  for (std::size_t i = 0; i < blur.size(); ++i)
    for (std::size_t j = 0; j < reflected[i].size(); ++j) blur[i].push_back(reflected[i][j] - sharp[i][j]);
  const Spread field = spread(reflected), blur_spread = spread(blur);
  judgement.reflected = field.mean;
  judgement.bias = blur_spread.mean;
  for (double variance : field.variance_of_mean) judgement.noise.push_back(std::sqrt(variance));
  const double reach = student95(sharp.size());
  for (double variance : spread(sharp).variance_of_mean)
    judgement.half_interval.push_back(reach * std::sqrt(variance));
  judgement.field_noise_w_per_mm2 =
      std::sqrt(mean(field.variance_of_mean) * static_cast<double>(reflected.size()));
  const double blur_rms = root_mean_square(judgement.bias);
  judgement.field_bias_w_per_mm2 = debiased_root(blur_rms * blur_rms, mean(blur_spread.variance_of_mean));
}

std::vector<Evaluation> evaluations(const Scene& scene, const Target& target, const Candidate& candidate,
                                    sim::Rung rung, std::uint64_t first_stream) {
  std::vector<Evaluation> list;
  const auto at = [&](std::uint64_t i) {
    return evaluate_by_rung(scene, rung, candidate, target.samples, first_stream + i);
  };
  if (rung == sim::Rung::tubes) {
    list.push_back(at(0));
    rung = list.front().rung;
    if (rung == sim::Rung::tubes) return list;
  }
  const std::uint64_t begun = list.size(), left = scene.model.replicates - begun;
  if (rung == sim::Rung::photons) {
    for (Evaluation& each :
         evaluate_sets_by_photons(scene, candidate, target.samples, first_stream + begun, left))
      list.push_back(std::move(each));
    return list;
  }
  for (const Bytes& each :
       ranks_of(scene).share(left, [&](std::size_t i) { return as_bytes(at(begun + i)); }))
    list.push_back(evaluation_of(each));
  return list;
}

/// What the luminaire is like from afar, where that is asked.
void add_intensity(Judgement& judgement, const Target& target, const Candidate& candidate, sim::Rung rung,
                   std::uint64_t first_stream) {
  if (!target.far) return;
  const FarField& far = *target.far;
  std::vector<Evaluation> list = evaluations(far.scene, far.target, candidate, rung, first_stream);
  Rows reflected;
  for (Evaluation& each : list) reflected.push_back(far.as_intensity(std::move(each.reflected)));
  const std::vector<double> direct = far.as_intensity(std::move(list.front().direct));
  if (list.front().rung != sim::Rung::tubes)
    judgement.far_photons = far.scene.model.photons.photons * list.size();
  for (const Metric metric : {Metric::relative_intensity_rmse, Metric::intensity_rmse})
    if (metric_value(metric, far.scene, far.target.irradiance_w_per_mm2, far.target))
      take_figure(judgement, far.scene, metric,
                  judge_metric(metric, far.scene, far.target, reflected, reflected, direct));
}

/// A field that reads dark only because no photon lies in any kernel would be stated without noise.
/// @fails InputError
void require_seen_light(const Scene& scene, const Judgement& judgement) {
  if (judgement.rung == sim::Rung::tubes) return;
  if (judgement.photons == 0)
    throw scene.settings.error("model.photons", "no photon is sent", "a field without photons is not known",
                               "100000, or ray tubes where they are valid");
  // Less than this is stray light at the field's edge, which samples may well not see.
  constexpr double stray = 1e-3;
  const double received = judgement.energy.received_w;
  const bool dark =
      std::all_of(judgement.reflected.begin(), judgement.reflected.end(), [](double e) { return e == 0; });
  if (!dark || !(received > stray * judgement.energy.emitted_w)) return;
  throw scene.settings.error(
      scene.model.estimate.neighbours ? "model.neighbours" : "model.kernel_radius",
      "no sample sees any of the light that arrives",
      fmt::format("the near field receives {:.3g} {}, and none of its photons lies in a sample's kernel",
                  received, flux_unit(scene.source.quantity)),
      "a wider kernel, more photons, or more samples");
}

AccuracyReport report_of(const sim::AccurateField& field, double asked_rel) {
  return {asked_rel,      field.noise_rel, field.bias_rel,      field.error95_rel, field.proven,
          field.sentence, field.order,     field.spent_photons, field.rays,        field.stages};
}

}  // namespace

Judgement judge(const Scene& scene, const Target& target, const Candidate& candidate, sim::Rung rung,
                std::uint64_t first_stream) {
  std::vector<Evaluation> list = evaluations(scene, target, candidate, rung, first_stream);
  Judgement judgement;
  judgement.rung = list.front().rung;
  const bool random = judgement.rung != sim::Rung::tubes;
  judgement.photons = random ? scene.model.photons.photons : 0;
  judgement.replicates = list.size();
  judgement.direct = list.front().direct;
  Rows reflected, sharp;
  const double share = 1.0 / static_cast<double>(list.size());
  for (Evaluation& each : list) {
    reflected.push_back(std::move(each.reflected));
    sharp.push_back(std::move(each.sharp));
    judgement.kernel_radius_mm += share * each.kernel_radius_mm;
    judgement.energy.add(each.energy, share);
    judgement.counts.add(each.counts);
  }
  fill_fields(judgement, reflected, sharp);
  judgement.field = field_figures(scene, target.samples, judgement.direct, reflected, sharp);
  judgement.further = further_figures(scene, target.samples, judgement.direct, reflected, sharp);
  require_seen_light(scene, judgement);
  fill_metrics(judgement, with_source(scene, candidate), target, reflected, sharp);
  add_intensity(judgement, target, candidate, rung, first_stream);
  return judgement;
}

Judgement judge_to_accuracy(const Scene& scene, const Target& target, const Candidate& candidate,
                            std::uint64_t first_stream, bool fresh_photons_only,
                            const std::function<bool(std::uint64_t, double)>& watch) {
  const Stage stage(scene, candidate);
  sim::AccuracyRequest request;
  request.relative = *scene.accuracy_rel;
  request.model = model_request(scene);
  request.model.estimate = {};
  request.photons = scene.model.photons;
  request.photons.stream = first_stream;
  request.most_photons = scene.model.most_photons;
  request.fresh_photons_only = fresh_photons_only;
  request.watch = watch;
  const auto reach = [&] { return sim::reach_accuracy(stage.scene, target.samples, request); };
  // A process by itself may be recording: its field is one entry then, from which the run is repeated.
  sim::AccurateField field =
      ranks_of(scene).size() > 1
          ? reach()
          : accurate_field_of(ranks_of(scene).from_first([&] { return as_bytes(reach()); }));
  Judgement judgement;
  judgement.rung = field.rung;
  judgement.accuracy = report_of(field, request.relative);
  judgement.photons = field.photons;
  judgement.replicates = field.sets;
  judgement.kernel_radius_mm = field.kernel_radius_mm;
  judgement.energy = field.energy;
  judgement.counts = field.counts;
  judgement.direct = std::move(field.direct);
  fill_fields(judgement, field.by_set, field.by_set);
  judgement.field = field_figures(scene, target.samples, judgement.direct, field.by_set, field.by_set);
  judgement.field_bias_w_per_mm2 =
      field.bias_rel * root_mean_square(sum(judgement.direct, judgement.reflected));
  fill_metrics(judgement, with_source(scene, candidate), target, field.by_set, field.by_set);
  add_intensity(judgement, target, candidate, sim::Rung::photons, first_stream);
  judgement.reflected = std::move(field.reflected);
  return judgement;
}

}  // namespace catoptric::design
