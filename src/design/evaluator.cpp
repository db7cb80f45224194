#include "design/evaluator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/contract.h"
#include "base/ordered_sum.h"
#include "design/stage.h"
#include "sim/photon_fields.h"
#include "sim/rings.h"
#include "sim/tubes.h"

namespace catoptric::design {
namespace {

/// Error asked of tubes, as a share of the irradiance that all of the source's power would give the near
/// field: 1e-6 W/m^2 in the paper's scene.
constexpr double tubes_tolerance_rel = 2.5e-7;
/// Tubes are believed up to this many times the tolerance: 1e-3 W/m^2 in the paper's scene, below what
/// photons reach.
constexpr double tubes_accepted = 1000;
/// The same of what the samples have: a faint or far mirror and a small patch of a wide beam get far less
/// than all of the source's power.
constexpr double tubes_tolerance_of_field = 1e-6, tubes_accepted_of_field = 1e-3;
/// Where paths are so many that this does not suffice, photons are cheaper.
constexpr int most_tube_rays = 20'000;
/// In a cavity one ray may meet the mirror a thousand times, so rays alone would allow seconds.
constexpr long most_tube_meetings = 8L * most_tube_rays;

sim::PhotonOptions photon_options(const Scene& scene, std::uint64_t stream) {
  sim::PhotonOptions options = scene.model.photons;
  options.stream = stream;
  return options;
}

/// Reflected light by tubes under the scene's kernel, or a narrower one; nothing where their bound is not
/// met.
std::optional<std::vector<double>> reflected_by_tubes(const Scene& scene, const sim::Scene& stage,
                                                      std::span<const sim::FieldSample> samples,
                                                      std::span<const double> direct,
                                                      double kernel_radius_mm) {
  sim::TubesOptions options = tubes_options(scene, kernel_radius_mm);
  constexpr int most_tries = 4;  // a first look may be as wrong as its tolerance allows
  for (int i = 0; i < most_tries; ++i) {
    sim::TubesField tubes = sim::tubes_field(stage, samples, options);
    if (!believed(tubes, options)) return std::nullopt;
    const std::vector<double> total = sum(direct, tubes.irradiance);
    const double peak = *std::max_element(total.begin(), total.end());
    if (tubes.error_w_per_mm2 <= tubes_accepted_of_field * peak) return std::move(tubes.irradiance);
    // More exact tubes take panels of kernels: over very many of these photons are cheaper.
    constexpr double narrowest = 1e-3;  // of the near field
    if (kernel_radius_mm <
        narrowest * std::max(scene.near_field.half_width_mm(), scene.near_field.half_height_mm()))
      return std::nullopt;
    options.tolerance_w_per_mm2 =
        std::min(tubes_tolerance_of_field * peak, tubes_accepted_of_field * options.tolerance_w_per_mm2);
    if (!(options.tolerance_w_per_mm2 > 0)) return std::nullopt;  // all dark, for what the bound is worth
  }
  return std::nullopt;
}

sim::RingPhotons ring_photons(const Scene& scene, const sim::Scene& stage, std::uint64_t stream) {
  sim::RingsOptions options;
  options.photons = photon_options(scene, stream);
  options.replicates = 1;
  options.widest_kernel_radius_mm = *scene.model.estimate.kernel_radius_mm;
  return {stage, options};
}

/// Half the kernel's area: half the neighbours, or the radius over root two.
sim::EstimateOptions half_area(sim::EstimateOptions options) {
  if (options.neighbours) options.neighbours = std::max<std::size_t>(1, *options.neighbours / 2);
  if (options.kernel_radius_mm) *options.kernel_radius_mm *= std::sqrt(0.5);
  return options;
}

/// For a kernel of second order E_r - E = c r^2, so halving the area halves the blur.
std::vector<double> extrapolated(std::span<const double> wide, std::span<const double> narrow) {
  std::vector<double> sharp(wide.size());
  for (std::size_t i = 0; i < sharp.size(); ++i) sharp[i] = 2 * narrow[i] - wide[i];
  return sharp;
}

double mean(std::span<const double> values) {
  return ordered_sum(values) / static_cast<double>(values.size());
}

std::vector<Evaluation> evaluate_by_photons(const Scene& scene, const Stage& stage,
                                            std::span<const sim::FieldSample> samples, std::uint64_t stream,
                                            std::uint64_t count) {
  const sim::EstimateOptions& full = scene.model.estimate;
  const std::vector<double> direct = sim::direct_field(stage.scene, samples);
  std::vector<Evaluation> evaluations;
  for (sim::PhotonFields& photons : sim::photon_fields_of_sets(
           stage.scene, samples, photon_options(scene, stream), std::array{full, half_area(full)}, count)) {
    sim::MapEstimate& wide = photons.estimates.front();
    std::vector<double> sharp = extrapolated(wide.irradiance, photons.estimates.back().irradiance);
    evaluations.push_back({sim::Rung::photons, direct, std::move(wide.irradiance), std::move(sharp),
                           mean(wide.kernel_radius_mm), photons.energy, photons.counts});
  }
  return evaluations;
}

Evaluation evaluate_by_rings(const Scene& scene, const Stage& stage,
                             std::span<const sim::FieldSample> samples, std::uint64_t stream) {
  const sim::RingPhotons photons = ring_photons(scene, stage.scene, stream);
  const std::vector<double> radii = sim::ring_radii_mm(scene.near_field, samples);
  const double radius_mm = *scene.model.estimate.kernel_radius_mm;
  std::vector<double> wide = photons.smoothed(radii, radius_mm);
  std::vector<double> sharp = extrapolated(wide, photons.smoothed(radii, std::sqrt(0.5) * radius_mm));
  return {sim::Rung::rings, sim::direct_field(stage.scene, samples),
          std::move(wide),  std::move(sharp),
          radius_mm,        photons.energy(),
          photons.counts()};
}

}  // namespace

sim::TubesOptions tubes_options(const Scene& scene, double kernel_radius_mm) {
  sim::TubesOptions options;
  options.kernel_radius_mm = kernel_radius_mm;
  options.most_interactions = scene.model.photons.most_interactions;
  options.tolerance_w_per_mm2 = tubes_tolerance_rel * scene.source.power_w / scene.near_field.area_mm2();
  options.most_rays = most_tube_rays;
  options.most_meetings = most_tube_meetings;
  return options;
}

bool believed(const sim::TubesField& field, const sim::TubesOptions& options) {
  return field.error_w_per_mm2 <= tubes_accepted * options.tolerance_w_per_mm2;
}

sim::Plan make_plan(const Scene& scene, const Candidate& candidate) {
  const Stage stage(scene, candidate);
  return sim::make_plan(stage.scene, model_request(scene));
}

sim::Plan make_plan(const Scene& scene, const SceneFamily& family) {
  std::vector<double> x;
  for (const optim::Variable& variable : scene.variables) x.push_back(variable.start);
  const auto plan_at = [&](const std::vector<double>& values) {
    return make_plan(scene, family.at(values).value_or(family.base()));
  };
  sim::Plan plan = plan_at(x);
  for (const std::size_t place : family.scene_places())
    for (const double bound : {scene.variables[place].lower, scene.variables[place].upper}) {
      std::vector<double> values = x;
      values[place] = bound;
      if (sim::Plan needed = plan_at(values); needed.rung > plan.rung) plan = std::move(needed);
    }
  return plan;
}

std::vector<double> total_by_rung(const Scene& scene, sim::Rung rung, const Candidate& candidate,
                                  std::span<const sim::FieldSample> samples, std::uint64_t stream) {
  const Stage stage(scene, candidate);
  const std::vector<double> direct = sim::direct_field(stage.scene, samples);
  if (rung == sim::Rung::tubes)
    if (const auto reflected =
            reflected_by_tubes(scene, stage.scene, samples, direct, *scene.model.estimate.kernel_radius_mm))
      return sum(direct, *reflected);
  if (rung == sim::Rung::rings)
    return sum(direct, ring_photons(scene, stage.scene, stream)
                           .smoothed(sim::ring_radii_mm(scene.near_field, samples),
                                     *scene.model.estimate.kernel_radius_mm));
  const sim::PhotonFields photons = sim::photon_fields(stage.scene, samples, photon_options(scene, stream),
                                                       std::array{scene.model.estimate});
  return sum(direct, photons.estimates.front().irradiance);
}

Evaluation evaluate_by_rung(const Scene& scene, sim::Rung rung, const Candidate& candidate,
                            std::span<const sim::FieldSample> samples, std::uint64_t stream) {
  const Stage stage(scene, candidate);
  if (rung == sim::Rung::rings) return evaluate_by_rings(scene, stage, samples, stream);
  if (rung == sim::Rung::tubes) {
    const double radius_mm = *scene.model.estimate.kernel_radius_mm;
    std::vector<double> direct = sim::direct_field(stage.scene, samples);
    auto wide = reflected_by_tubes(scene, stage.scene, samples, direct, radius_mm);
    const auto narrow = reflected_by_tubes(scene, stage.scene, samples, direct, std::sqrt(0.5) * radius_mm);
    if (wide && narrow) {
      std::vector<double> sharp = extrapolated(*wide, *narrow);
      return {rung, std::move(direct), std::move(*wide), std::move(sharp), radius_mm, {}, {}};
    }
  }
  return std::move(evaluate_by_photons(scene, stage, samples, stream, 1).front());
}

std::vector<Evaluation> evaluate_sets_by_photons(const Scene& scene, const Candidate& candidate,
                                                 std::span<const sim::FieldSample> samples,
                                                 std::uint64_t stream, std::uint64_t count) {
  return evaluate_by_photons(scene, Stage(scene, candidate), samples, stream, count);
}

double root_mean_square_error(std::span<const double> values, std::span<const double> target,
                              std::span<const double> weights) {
  CATOPTRIC_EXPECTS(values.size() == target.size() && !values.empty());
  CATOPTRIC_EXPECTS(weights.empty() || weights.size() == values.size());
  std::vector<double> squares(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    squares[i] = (values[i] - target[i]) * (values[i] - target[i]) * (weights.empty() ? 1.0 : weights[i]);
  return std::sqrt(ordered_sum(squares) /
                   (weights.empty() ? static_cast<double>(values.size()) : ordered_sum(weights)));
}

double root_mean_square(std::span<const double> values, std::span<const double> weights) {
  return root_mean_square_error(values, std::vector<double>(values.size(), 0.0), weights);
}

std::vector<double> sum(std::span<const double> a, std::span<const double> b) {
  std::vector<double> total(a.size());
  for (std::size_t i = 0; i < total.size(); ++i) total[i] = a[i] + b[i];
  return total;
}

}  // namespace catoptric::design
