#include "design/judge.h"

#include <cmath>

#include "base/ordered_sum.h"
#include "design/evaluator.h"

namespace catoptric::design {
namespace {

/// Mean and variance of the mean, sample by sample, over replicates.
struct Spread {
  std::vector<double> mean, variance_of_mean;
};

Spread spread(const std::vector<std::vector<double>>& rows) {
  const std::size_t count = rows.front().size();
  const double n = static_cast<double>(rows.size());
  Spread result{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
  for (const auto& row : rows)
    for (std::size_t j = 0; j < count; ++j) result.mean[j] += row[j] / n;
  for (const auto& row : rows)
    for (std::size_t j = 0; j < count; ++j) {
      const double off = row[j] - result.mean[j];
      result.variance_of_mean[j] += off * off / (n * (n - 1));
    }
  return result;
}

double mean(const std::vector<double>& values) {
  return ordered_sum(values) / static_cast<double>(values.size());
}

/// Root of a mean square from which the noise's own share is taken; 0 where noise explains it all.
double debiased_root(double mean_square, double noise_square) {
  return std::sqrt(std::max(0.0, mean_square - noise_square));
}

/// The objective a field without noise and blur would have.
double debiased_objective(const Scene& scene, const Target& target, const Spread& sharp,
                          const std::vector<double>& direct) {
  std::vector<double> field(sharp.mean);
  for (std::size_t j = 0; j < field.size(); ++j) field[j] += direct[j];
  const double rmse = root_mean_square_error(field, target.irradiance_w_per_mm2);
  const double clean = debiased_root(rmse * rmse, mean(sharp.variance_of_mean));
  return scene.search.metric == Metric::rmse ? to_w_per_m2(clean)
                                             : clean / root_mean_square(target.irradiance_w_per_mm2);
}

void add(sim::EnergyLedger& sum, const sim::EnergyLedger& part, double share) {
  sum.emitted_w += share * part.emitted_w;
  sum.missed_w += share * part.missed_w;
  sum.absorbed_w += share * part.absorbed_w;
  sum.received_w += share * part.received_w;
  sum.escaped_w += share * part.escaped_w;
  sum.cut_off_w += share * part.cut_off_w;
}

void add(sim::PhotonCounts& sum, const sim::PhotonCounts& part) {
  sum.emitted += part.emitted;
  sum.met_mirror += part.met_mirror;
  sum.stored += part.stored;
  sum.interactions += part.interactions;
}

}  // namespace

Judgement judge(const Scene& scene, const Target& target, const Profile& profile,
                std::uint64_t first_stream) {
  Judgement judgement;
  judgement.photons = scene.model.photons.photons;
  judgement.replicates = scene.model.replicates;
  judgement.has_objective = !target.irradiance_w_per_mm2.empty();
  std::vector<std::vector<double>> blurred, blur, sharp;
  std::vector<double> objectives, radii;
  for (std::uint64_t i = 0; i < scene.model.replicates; ++i) {
    const FieldPair pair = estimate_field_pair(scene, profile, target.samples, first_stream + i);
    blurred.push_back(pair.field.reflected);
    // For a kernel of second order E_r - E = c r^2, so halving the area halves the blur.
    blur.emplace_back(pair.field.reflected.size());
    sharp.emplace_back(pair.field.reflected.size());
    for (std::size_t j = 0; j < pair.field.reflected.size(); ++j) {
      blur.back()[j] = 2 * (pair.field.reflected[j] - pair.half_area_reflected[j]);
      sharp.back()[j] = pair.field.reflected[j] - blur.back()[j];
    }
    judgement.direct = pair.field.direct;
    radii.push_back(mean(pair.field.kernel_radius_mm));
    if (judgement.has_objective)
      objectives.push_back(objective(scene, total(pair.field), target.irradiance_w_per_mm2));
    add(judgement.energy, pair.field.energy, 1.0 / static_cast<double>(scene.model.replicates));
    add(judgement.counts, pair.field.counts);
  }
  const Spread field = spread(blurred), blur_spread = spread(blur);
  judgement.reflected = field.mean;
  judgement.bias = blur_spread.mean;
  for (double variance : field.variance_of_mean) judgement.noise.push_back(std::sqrt(variance));
  judgement.kernel_radius_mm = mean(radii);
  judgement.field_noise_w_per_mm2 =
      std::sqrt(mean(field.variance_of_mean) * static_cast<double>(scene.model.replicates));
  const double blur_rms = root_mean_square(judgement.bias);
  judgement.field_bias_w_per_mm2 = debiased_root(blur_rms * blur_rms, mean(blur_spread.variance_of_mean));
  if (judgement.has_objective) {
    std::vector<std::vector<double>> rows;
    for (double value : objectives) rows.push_back({value});
    const Spread value = spread(rows);
    judgement.objective.value = value.mean[0];
    judgement.objective.noise = std::sqrt(value.variance_of_mean[0]);
    judgement.objective.bias =
        value.mean[0] - debiased_objective(scene, target, spread(sharp), judgement.direct);
  }
  return judgement;
}

}  // namespace catoptric::design
