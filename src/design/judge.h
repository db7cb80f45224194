#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "design/field_figures.h"
#include "design/replicates.h"
#include "design/scene.h"
#include "design/target.h"
#include "sim/accuracy.h"

namespace catoptric::design {

/// One metric in its own unit and sense.
struct MetricFigure {
  Metric metric;
  Figure figure;
};

/// How an accuracy that the scene asked for was reached.
struct AccuracyReport {
  double asked_rel = 0, noise_rel = 0, bias_rel = 0, error95_rel = 0;
  bool proven = false;
  std::string sentence;
  int order = 0;
  std::uint64_t spent_photons = 0;
  int rays = 0;
  std::vector<sim::AccuracyStage> stages;
};

/// A mirror judged on random streams that no search used.
struct Judgement {
  sim::Rung rung = sim::Rung::photons;
  Figure objective;  ///< as the search makes it small; all 0 when the scene has no target
  bool has_objective = false;
  std::vector<MetricFigure> metrics;    ///< every metric that has a value here, searched or not
  FieldFigures field;                   ///< the near field by itself, whatever is wanted
  std::vector<FurtherFigures> further;  ///< the further fields likewise
  double kernel_radius_mm = 0;          ///< mean over the samples; 0: the field itself, without a kernel
  std::uint64_t photons = 0;            ///< of one evaluation
  std::uint64_t replicates = 0;
  std::uint64_t far_photons = 0;          ///< of all evaluations of the intensity
  std::vector<double> direct, reflected;  ///< W/mm^2, means over replicates
  std::vector<double> noise;              ///< W/mm^2, standard error of `reflected`
  std::vector<double> bias;               ///< W/mm^2, estimated kernel blur of `reflected`
  std::vector<double> half_interval;  ///< W/mm^2: reflected - bias give or take this holds the truth, 95 %
  double field_noise_w_per_mm2 = 0;   ///< root mean square over the samples of one evaluation's noise
  double field_bias_w_per_mm2 = 0;    ///< root mean square of `bias`, its own noise taken off
  sim::EnergyLedger energy;           ///< mean over replicates; empty for tubes
  sim::PhotonCounts counts;           ///< sum over replicates
  std::optional<AccuracyReport> accuracy;  ///< where the scene asks for one
};

/// Judges a mirror by `model.replicates` independent evaluations of a rung, each with two bandwidths; tubes,
/// in which nothing is random, are evaluated once.
/// @error the blur is extrapolated from two kernel areas: right where the field is smooth over a kernel, too
///        small at jumps and caustics; the intervals are as good as it is
/// @from  noise: spread of replicates, Student's t; bias: Richardson extrapolation of a kernel of second
/// order
///        (Silverman 1986, section 3.3); the objective's interval: jackknife over the replicates (Miller
///        1974)
Judgement judge(const Scene& scene, const Target& target, const Candidate& candidate, sim::Rung rung,
                std::uint64_t first_stream);
inline Judgement judge(const Scene& scene, const Target& target, const Profile& profile, sim::Rung rung,
                       std::uint64_t first_stream) {
  return judge(scene, target, scene.with(profile), rung, first_stream);
}

/// Judges a mirror with as many photons as the scene's accuracy takes. The field is the irradiance itself;
/// the kernel's blur has been extrapolated away and what may be left of it is in the report.
/// @in    the scene asks for an accuracy; fresh_photons_only: not by tubes, which the search may have used
/// @fails as sim::reach_accuracy
Judgement judge_to_accuracy(const Scene& scene, const Target& target, const Candidate& candidate,
                            std::uint64_t first_stream, bool fresh_photons_only,
                            const std::function<bool(std::uint64_t, double)>& watch);
inline Judgement judge_to_accuracy(const Scene& scene, const Target& target, const Profile& profile,
                                   std::uint64_t first_stream, bool fresh_photons_only,
                                   const std::function<bool(std::uint64_t, double)>& watch) {
  return judge_to_accuracy(scene, target, scene.with(profile), first_stream, fresh_photons_only, watch);
}

}  // namespace catoptric::design
