#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/intensity_table.h"
#include "design/run.h"

namespace catoptric::design {

/// A number with its standard error, from the spread of the replicates.
struct Measured {
  double value = 0, noise = 0;
};

/// Light between two angles to the luminaire's axis.
struct ZonalFlux {
  double from_deg, to_deg;
  Measured flux;
};

/// Full angle within which the intensity stays above a share of the greatest, in the plane C, C + 180.
/// Nothing where it does not fall below it on both sides of the axis.
struct BeamAngle {
  double c_deg;
  std::optional<double> half_deg, tenth_deg;  ///< above a half: beam angle; above a tenth: field angle
};

/// The luminaire from afar: source and mirror, without the near field.
struct LuminaireIntensity {
  Profile profile;
  IntensityTable table;       ///< mean over the replicates; gamma = 0 points along the beam
  std::vector<double> noise;  ///< of each value, standard error
  std::vector<double> bias;   ///< of each value: what the width of the steps does to it
  Vector3 beam;               ///< direction of gamma = 0
  double source_flux;         ///< W or lm
  Measured flux;              ///< that leaves the luminaire
  Measured peak = {};         ///< greatest intensity
  double peak_gamma_deg = 0, peak_c_deg = 0;
  std::vector<BeamAngle> angles = {};
  std::vector<ZonalFlux> zones = {};
  std::string remark = {};  ///< where the steps are too wide for this light; else empty
  double noise_rel = 0,
         bias_rel = 0;  ///< root mean square over the sphere, relative to that of the intensity
  std::uint64_t photons = 0;
  double seconds = 0;
};

/// Traces the scene's luminaire by `model.replicates` sets of `model.photons` photons on fresh streams.
/// @fails InputError for a scene whose photons are none; Interrupted
LuminaireIntensity run_intensity(const Scene& scene, const RunControl& control);

/// Beam and field angle of a table in the plane of one C and its opposite, by the bilinear interpolant.
/// @in    c_deg: of a plane
BeamAngle beam_angle(const IntensityTable& table, double c_deg);

}  // namespace catoptric::design
