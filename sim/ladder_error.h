#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/bandwidth_ladder.h"

namespace catoptric::sim {

/// The sets' mean at the samples.
std::vector<double> mean_of(const SetFields& sets);
/// Standard deviation of that mean at each sample, by the sets' spread.
std::vector<double> deviation_of_mean(const SetFields& sets);
const SetFields& fields_of(const LadderLevel& level, int order);

/// What a level's estimates of one order tell, as mean squares over the samples, W^2/mm^4.
struct LadderReading {
  double variance = 0;         ///< of the sets' mean
  double change = 0;           ///< square of what narrowing by one level changes in that mean
  double change_variance = 0;  ///< how much of `change` the sets' spread explains
};

/// A ladder without its fields. The last level's change is not known.
struct LadderSummary {
  struct Level {
    double excess = 1;  ///< by how much a mean square over its kernels may exceed its expectation
    double unseen = 0;  ///< mean square of what kernels without a photon may hide, W^2/mm^4
    std::array<LadderReading, 2> orders;  ///< second and fourth
  };
  std::vector<Level> levels;  ///< widest first
  bool smooth = false;        ///< the field is known to have no jumps, folds or foci
};

/// What the sets were made of.
struct LadderPhotons {
  double power_w = 0;   ///< of one photon, where the light of all sets together is one field's
  double area_mm2 = 1;  ///< of the near field
};

/// @in two levels and two sets at least; smooth: what is known of the field (see field_breaks.h); shares: of
///     the field, that each sample stands for, nothing where all stand for the same
LadderSummary summary_of(const BandwidthLadder& ladder, bool smooth, std::span<const double> shares = {},
                         const LadderPhotons& photons = {});

/// One way to read a ladder: a level, and which of its two estimates.
struct LadderChoice {
  std::size_t level = 0;
  int order = 2;       ///< of the bias: 2 or 4
  double noise = 0;    ///< standard deviation of the sets' mean, root mean square over the samples, W/mm^2
  double bias = 0;     ///< upper estimate of what the kernel adds, root mean square over the samples
  double error95 = 0;  ///< root mean square error that is not exceeded with a probability of 95 %
};

/// The reading of a ladder with the least error.
///
/// Noise comes from the spread of the sets. Its mean square over the samples is known as well as the number
/// of independent kernels allows, so the 95 % bound is that of an F distribution. Bias is the sum of what
/// each further narrowing changes, as far as the changes stand out of their own noise; from there on they are
/// continued as the geometric series that the last ones make: a quarter or half a step where they show, or
/// where it is known, that the field is smooth, else as slowly as at a jump. Where not even the widest kernel
/// shows a change, that is taken which noise could hide. Kernels in which no photon landed show neither noise
/// nor change: all of them together may still get the light of three photons (95 %), and all in one place.
/// @from  Lepski 1991 for the comparison of bandwidths
LadderChoice best_choice(const LadderSummary& ladder);

/// What so many times the photons are expected to show. Noise depends on the number of photons in a kernel,
/// so that the ladder itself says what it is with other numbers; bias does not depend on it, and changes that
/// noise hides today follow the last ones seen.
LadderSummary expected_with(const LadderSummary& ladder, double times_the_photons);

}  // namespace catoptric::sim
