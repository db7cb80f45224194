#pragma once

#include <optional>
#include <string>
#include <vector>

#include "design/deviations.h"
#include "design/run.h"

namespace catoptric::design {

/// A root mean square change of the field over the near field's samples, relative to the root mean square of
/// the field itself.
struct FieldChange {
  double value_rel = 0;
  double noise_rel = 0;  ///< standard error; 0 for tubes
};

/// The deviation to one side that costs what is allowed.
struct Tolerated {
  double deviation = 0;
  FieldChange change;  ///< by simulation of that very deviation
};

/// What one deviation does to the light.
struct ParameterSensitivity {
  Deviation deviation;
  sim::Rung rung;  ///< that the deviated scene needs
  std::uint64_t replicates = 1;
  double step = 0;                   ///< of the central differences, in the deviation's unit
  FieldChange change_per_unit = {};  ///< for small deviations
  double nonlinearity_rel = 0;  ///< difference of the derivatives with the step and with twice the step, over
                                ///< the first; with photons noise is in it
  std::vector<double> derivative_w_per_mm2 =
      {};  ///< dE/dp at Sensitivity::radii_mm, per unit of the deviation
  std::vector<double> derivative_noise_w_per_mm2 = {};
  std::optional<Tolerated> minus = {},
                           plus = {};  ///< nothing where no deviation that makes sense costs so much
  std::uint64_t photons = 0;           ///< spent on deviated scenes

  /// The lesser of the two: what a maker may be told. Nothing when both sides are free.
  std::optional<double> tolerance() const;
};

/// How the field of a mirror changes with what may be wrong.
struct Sensitivity {
  Profile profile;
  std::vector<double> radii_mm;         ///< from the near field's centre along its first axis
  std::vector<double> field_w_per_mm2;  ///< total irradiance there, nothing wrong
  double field_rms_w_per_mm2 = 0;       ///< over the samples
  double allowed_rel = 0;
  std::vector<ParameterSensitivity> parameters;
  std::uint64_t photons = 0;
  double seconds = 0;

  /// How many parameters have a tolerance: with all of them at it, independent of each other, the changes add
  /// up to allowed_rel times the root of this; each at its tolerance over that root, to allowed_rel.
  std::size_t budgeted() const;
};

/// Measures every deviation: the two that cost `sensitivity.allowed`, by simulation, and derivatives by
/// central differences. Each is computed by the cheapest rung valid for the deviated scene; with photons the
/// same random numbers are used with and without the deviation, in `model.replicates` independent
/// repetitions, and noise is taken off what eq. 7 counts as change.
/// @out   `parameters` by rank 0 alone, the same bits for any number of ranks, which share the deviations
/// @fails InputError as a simulation of the scene; Interrupted
/// @error a tolerance costs what is allowed to 0.5 %, with photons to their noise, which is stated
Sensitivity run_sensitivity(const Scene& scene, const RunControl& control);

}  // namespace catoptric::design
