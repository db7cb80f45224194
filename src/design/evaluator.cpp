#include "design/evaluator.h"

#include <cmath>

#include "base/contract.h"
#include "base/ordered_sum.h"
#include "cad/engines.h"
#include "sim/source.h"
#include "sim/tubes.h"

namespace catoptric::design {
namespace {

/// What one evaluation borrows: the mirror in the engine the scene asks for, and the source.
struct Stage {
  Stage(const Scene& spec, const Profile& profile)
      : source(spec.source.position_mm, spec.source.power_w),
        mirror(spec.model.engine == Engine::occt ? cad::make_occt_reflector(profile)
                                                 : cad::make_meridian_reflector(profile)),
        scene{source, *mirror, spec.mirror, spec.near_field} {}
  sim::PointSource source;
  std::unique_ptr<Reflector> mirror;
  sim::Scene scene;
};

/// Error asked of tubes, as a share of the irradiance that all of the source's power would give the near
/// field: 1e-6 W/m^2 in the paper's scene.
constexpr double tubes_tolerance_rel = 2.5e-7;
/// Tubes are believed up to this many times the tolerance: 1e-3 W/m^2 in the paper's scene, below what
/// photons reach.
constexpr double tubes_accepted = 1000;
/// Where paths are so many that this does not suffice, photons are cheaper.
constexpr int most_tube_rays = 20'000;

sim::PhotonOptions photon_options(const Scene& scene, std::uint64_t stream) {
  sim::PhotonOptions options = scene.model.photons;
  options.stream = stream;
  return options;
}

/// Half the kernel's area: half the neighbours, or the radius over root two.
sim::EstimateOptions half_bandwidth(sim::EstimateOptions options) {
  if (options.neighbours) options.neighbours = std::max<std::size_t>(1, *options.neighbours / 2);
  if (options.kernel_radius_mm) *options.kernel_radius_mm *= std::sqrt(0.5);
  return options;
}

}  // namespace

sim::FieldEstimate estimate_field(const Scene& scene, const Profile& profile,
                                  std::span<const sim::FieldSample> samples, std::uint64_t stream) {
  const Stage stage(scene, profile);
  return sim::simulate(stage.scene, samples, photon_options(scene, stream), scene.model.estimate);
}

sim::Plan search_plan(const Scene& scene, const Profile& profile) {
  const Stage stage(scene, profile);
  return sim::make_plan(stage.scene, scene.model.estimate, scene.model.rung);
}

std::vector<double> total_by_rung(const Scene& scene, sim::Rung rung, const Profile& profile,
                                  std::span<const sim::FieldSample> samples, std::uint64_t stream) {
  if (rung == sim::Rung::photons) return total(estimate_field(scene, profile, samples, stream));
  const Stage stage(scene, profile);
  sim::TubesOptions options;
  options.kernel_radius_mm = *scene.model.estimate.kernel_radius_mm;
  options.most_interactions = scene.model.photons.most_interactions;
  options.tolerance_w_per_mm2 = tubes_tolerance_rel * scene.source.power_w / scene.near_field.area_mm2();
  options.most_rays = most_tube_rays;
  sim::TubesField tubes = sim::tubes_field(stage.scene, samples, options);
  // Cavities can need more tubes than photons are worth: a bound that is not met is not believed.
  if (!(tubes.error_w_per_mm2 <= tubes_accepted * options.tolerance_w_per_mm2))
    return total(estimate_field(scene, profile, samples, stream));
  std::vector<double> sum = std::move(tubes.irradiance);
  const std::vector<double> direct = sim::direct_field(stage.scene, samples);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += direct[i];
  return sum;
}

FieldPair estimate_field_pair(const Scene& scene, const Profile& profile,
                              std::span<const sim::FieldSample> samples, std::uint64_t stream) {
  const Stage stage(scene, profile);
  const sim::EstimateOptions& full = scene.model.estimate;
  const sim::TracedPhotons photons = sim::trace_photons(stage.scene, photon_options(scene, stream),
                                                        sim::recording_margin_mm(scene.near_field, full));
  const sim::PhotonMap map(scene.near_field, photons);
  sim::MapEstimate blurred = map.estimate(samples, full);
  return {{sim::direct_field(stage.scene, samples), std::move(blurred.irradiance), std::move(blurred.noise),
           std::move(blurred.kernel_radius_mm), photons.energy, photons.counts},
          map.estimate(samples, half_bandwidth(full)).irradiance};
}

double root_mean_square_error(std::span<const double> values, std::span<const double> target) {
  CATOPTRIC_EXPECTS(values.size() == target.size() && !values.empty());
  std::vector<double> squares(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    squares[i] = (values[i] - target[i]) * (values[i] - target[i]);
  return std::sqrt(ordered_sum(squares) / static_cast<double>(values.size()));
}

double root_mean_square(std::span<const double> values) {
  return root_mean_square_error(values, std::vector<double>(values.size(), 0.0));
}

std::vector<double> total(const sim::FieldEstimate& field) {
  std::vector<double> sum(field.direct.size());
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = field.direct[i] + field.reflected[i];
  return sum;
}

double objective(const Scene& scene, std::span<const double> total_w_per_mm2,
                 std::span<const double> target_w_per_mm2) {
  const double rmse = root_mean_square_error(total_w_per_mm2, target_w_per_mm2);
  return scene.search.metric == Metric::rmse ? to_w_per_m2(rmse) : rmse / root_mean_square(target_w_per_mm2);
}

}  // namespace catoptric::design
