#pragma once

#include <vector>

#include "design/scene.h"
#include "design/target.h"

namespace catoptric::design {

/// The objective with what is known of its error: the truth lies near value - bias, give or take noise.
struct Figure {
  double value = 0;  ///< mean over replicates of the objective as the search computes it
  double noise = 0;  ///< standard error of `value`, from the replicates' spread
  double bias = 0;   ///< estimated systematic part of `value`: photon noise that eq. 7 counts as error, and
                     ///< the kernel's blur
};

/// A mirror judged on random streams that no search used.
struct Judgement {
  Figure objective;  ///< in the metric's unit; all 0 when the scene has no target
  bool has_objective = false;
  double kernel_radius_mm = 0;  ///< mean over the samples
  std::uint64_t photons = 0;    ///< of one evaluation
  std::uint64_t replicates = 0;
  std::vector<double> direct, reflected;  ///< W/mm^2, means over replicates
  std::vector<double> noise;              ///< W/mm^2, standard error of `reflected`
  std::vector<double> bias;               ///< W/mm^2, estimated kernel blur of `reflected`
  double field_noise_w_per_mm2 = 0;       ///< root mean square over the samples of one evaluation's noise
  double field_bias_w_per_mm2 = 0;        ///< root mean square of `bias`, its own noise taken off
  sim::EnergyLedger energy;               ///< mean over replicates
  sim::PhotonCounts counts;               ///< sum over replicates
};

/// Judges a mirror by `model.replicates` independent evaluations, each with two bandwidths.
/// @error the blur is extrapolated from two kernel areas: right where the field is smooth over a kernel, too
/// small at
///        jumps and caustics
/// @from  noise: spread of replicates; bias: Richardson extrapolation of a kernel of second order (Silverman
/// 1986,
///        section 3.3)
Judgement judge(const Scene& scene, const Target& target, const Profile& profile, std::uint64_t first_stream);

}  // namespace catoptric::design
