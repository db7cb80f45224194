#pragma once

#include <optional>
#include <span>
#include <string>

#include "design/scene.h"
#include "design/target.h"

namespace catoptric::design {

/// All metrics, in the order in which they are reported.
std::span<const Metric> all_metrics();

/// Whether it compares what is seen from afar, of a FarField.
bool is_of_intensity(Metric metric);
/// Whether a search makes it large.
bool more_is_better(Metric metric);
/// What a search makes small, in words: the metric, or 1 less it where more is better.
std::string objective_name(Metric metric);
/// "W/m^2" or "lx", "W/sr" or "cd", or empty for a ratio.
std::string unit(Metric metric, LightQuantity quantity);
/// Of the metric that is searched.
std::string objective_unit(const Scene& scene);

/// A field's metric against the target, in its own unit.
/// rmse, relative_rmse: eq. 7, each sample with its weight; with a free scale against the level that fits
/// best. uniformity, diversity: least over mean, and over greatest, irradiance on the lit samples, those of
/// weight 0 left out.
/// enclosed_flux, efficiency: light within the target's reach, or on its lit part, over the source's power;
/// every sample stands for the same area, whatever its weight. intensity_rmse: root mean square over
/// directions even in solid angle, of a FarField, whose target and intensities (W/sr) it takes;
/// relative_intensity_rmse: over that of the table, or with a free scale as relative_rmse.
/// @out   nothing where there is no target, no lit sample, or a relative error has nothing to refer to
/// @error flux and uniformity see the field where the samples are; a flux is off by about the share of its
///        samples that are neighbours of the zone's edge, times 1 / sqrt of their number
/// @from  eq. 7; U0 = Emin / Eavg and Ud = Emin / Emax of EN 12464-1; utilisation factor (flux on the area
/// over the lamp's)
std::optional<double> metric_value(Metric metric, const Scene& scene, std::span<const double> total_w_per_mm2,
                                   const Target& target);

/// What the search makes small: the scene's metric, or 1 less it where more is better.
/// @in    the metric has a value (see require_metric)
double objective(const Scene& scene, std::span<const double> total_w_per_mm2, const Target& target);
/// A metric's value as an objective, and back.
double as_objective(Metric metric, double value);

/// @fails InputError when the scene's metric says nothing about its target
void require_metric(const Scene& scene, const Target& target);

}  // namespace catoptric::design
