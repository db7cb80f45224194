#pragma once

#include <span>
#include <vector>

#include "design/scene.h"
#include "sim/simulation.h"

namespace catoptric::design {

/// The light of one mirror in the scene, by the photons of one stream.
sim::FieldEstimate estimate_field(const Scene& scene, const Profile& profile,
                                  std::span<const sim::FieldSample> samples, std::uint64_t stream);

/// What the search computes a mirror's light with in this scene, and why.
/// @fails InputError when the scene forces a rung that is not valid
sim::Plan search_plan(const Scene& scene, const Profile& profile);

/// The light of one mirror by a rung: total irradiance at the samples, W/mm^2. Photons come from `stream`;
/// they also stand in where tubes cannot meet their error bound (cavities with very many paths).
std::vector<double> total_by_rung(const Scene& scene, sim::Rung rung, const Profile& profile,
                                  std::span<const sim::FieldSample> samples, std::uint64_t stream);

/// The same photons seen with two bandwidths: the scene's, and the one of half the kernel area that shows the
/// bias.
struct FieldPair {
  sim::FieldEstimate field;
  std::vector<double> half_area_reflected;  ///< W/mm^2
};
FieldPair estimate_field_pair(const Scene& scene, const Profile& profile,
                              std::span<const sim::FieldSample> samples, std::uint64_t stream);

/// Root of the mean squared difference.  @from paper eq. 7
double root_mean_square_error(std::span<const double> values, std::span<const double> target);
double root_mean_square(std::span<const double> values);

/// Direct plus reflected.
std::vector<double> total(const sim::FieldEstimate& field);

/// The scene's metric of a field against its target: W/m^2, or a ratio for relative-rmse.
double objective(const Scene& scene, std::span<const double> total_w_per_mm2,
                 std::span<const double> target_w_per_mm2);

}  // namespace catoptric::design
