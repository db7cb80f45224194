#pragma once

#include <span>
#include <vector>

#include "design/scene.h"
#include "sim/simulation.h"
#include "sim/tubes.h"

namespace catoptric::design {

/// What the search computes a mirror's light with in this scene, and why.
/// @fails InputError when the scene forces a rung that is not valid
sim::Plan make_plan(const Scene& scene, const Candidate& candidate);

/// The same for a whole family: the dearest rung that its start, or its bounds beside the shape, need (a
/// source that may leave the axis).
/// @in    of scene.variables, with their start values
sim::Plan make_plan(const Scene& scene, const SceneFamily& family);

/// The light of one mirror by a rung: total irradiance at the samples, W/mm^2. Photons come from `stream`;
/// they also stand in where tubes cannot meet their error bound (cavities with very many paths).
std::vector<double> total_by_rung(const Scene& scene, sim::Rung rung, const Candidate& candidate,
                                  std::span<const sim::FieldSample> samples, std::uint64_t stream);

/// What ray tubes are asked for in this scene, with a kernel of that radius; and whether their error is small
/// enough to go on with.
sim::TubesOptions tubes_options(const Scene& scene, double kernel_radius_mm);
bool believed(const sim::TubesField& field, const sim::TubesOptions& options);

/// The light of one mirror by one set of random numbers, or by none, W/mm^2 at the samples.
struct Evaluation {
  sim::Rung rung;                 ///< photons also stand in for tubes that cannot meet their error bound
  std::vector<double> direct;     ///< computed, with occlusion by the mirror
  std::vector<double> reflected;  ///< as the scene's kernel shows it
  std::vector<double> sharp;      ///< the same with the kernel's blur extrapolated away
  double kernel_radius_mm = 0;    ///< mean over the samples
  sim::EnergyLedger energy;       ///< of photons; empty for tubes
  sim::PhotonCounts counts;
};

/// Evaluates a mirror with two bandwidths, whose difference shows the kernel's blur.
/// @error the blur is extrapolated from two kernel areas: right where the field is smooth over a kernel, too
///        small at jumps and caustics
/// @from  Richardson extrapolation of a kernel of second order: Schucany & Sommers 1977
Evaluation evaluate_by_rung(const Scene& scene, sim::Rung rung, const Candidate& candidate,
                            std::span<const sim::FieldSample> samples, std::uint64_t stream);

/// The same by so many sets of photons, set i on stream + i, whose batches the scene's ranks share.
std::vector<Evaluation> evaluate_sets_by_photons(const Scene& scene, const Candidate& candidate,
                                                 std::span<const sim::FieldSample> samples,
                                                 std::uint64_t stream, std::uint64_t count);

// The same for a mirror's shape in the scene as it is written.
inline sim::Plan make_plan(const Scene& scene, const Profile& profile) {
  return make_plan(scene, scene.with(profile));
}
inline std::vector<double> total_by_rung(const Scene& scene, sim::Rung rung, const Profile& profile,
                                         std::span<const sim::FieldSample> samples, std::uint64_t stream) {
  return total_by_rung(scene, rung, scene.with(profile), samples, stream);
}
inline Evaluation evaluate_by_rung(const Scene& scene, sim::Rung rung, const Profile& profile,
                                   std::span<const sim::FieldSample> samples, std::uint64_t stream) {
  return evaluate_by_rung(scene, rung, scene.with(profile), samples, stream);
}

/// Root of the mean squared difference, weighted unless the weights are empty.  @from paper eq. 7
double root_mean_square_error(std::span<const double> values, std::span<const double> target,
                              std::span<const double> weights = {});
double root_mean_square(std::span<const double> values, std::span<const double> weights = {});

/// Element by element.
std::vector<double> sum(std::span<const double> a, std::span<const double> b);

}  // namespace catoptric::design
