#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "design/replicates.h"
#include "design/scene.h"
#include "sim/near_field.h"

namespace catoptric::design {

/// Light on a part of the near field: what lies between two radii.
struct ZoneFigures {
  double from_mm = 0;
  std::optional<double> to_mm;  ///< nothing: as far as the near field goes
  std::size_t samples = 0;      ///< in it
  Figure flux_w;
  Figure irradiance_w_per_mm2;  ///< its mean
};

/// What the near field gets, whatever is wanted of it: of all its light, direct light included, at the
/// samples.
struct FieldFigures {
  Figure average_w_per_mm2, least_w_per_mm2, greatest_w_per_mm2;
  Figure uniformity;               ///< U0: least over average
  Figure diversity;                ///< Ud: least over greatest
  std::optional<Figure> flux_w;    ///< nothing where the samples are a table's, which stand for no area
  std::vector<ZoneFigures> zones;  ///< the target's zones, and what lies beyond them; else rings of equal
                                   ///< width on a disc. Empty on a rectangle, whose one zone is the whole
  bool zones_about_axis = false;   ///< radii from the z axis; else from the disc's centre
};

/// The same of one of the further fields.
struct FurtherFigures {
  std::string name;
  std::size_t samples;
  double spacing_mm;     ///< the samples' mean distance: the root of a sample's area
  FieldFigures figures;  ///< without zones
};

/// @in    reflected, sharp: of each replicate as the kernel shows it, and with the blur extrapolated away
/// @error least and greatest are those of the samples; photon noise makes them more extreme, for which their
///        intervals have room where it cannot tell the extreme samples apart; the bias of few photons may
///        have the wrong sign there. Every sample stands for the same area, so that a zone's flux is off by
///        about the share of its samples that are neighbours of its edge, times 1 / sqrt of their number
/// @from  U0 and Ud: EN 12464-1
FieldFigures field_figures(const Scene& scene, std::span<const sim::FieldSample> samples,
                           const std::vector<double>& direct, const Rows& reflected, const Rows& sharp);

/// Of the scene's further fields, in their order; the arguments as those of field_figures, all samples among
/// them.
std::vector<FurtherFigures> further_figures(const Scene& scene, std::span<const sim::FieldSample> samples,
                                            const std::vector<double>& direct, const Rows& reflected,
                                            const Rows& sharp);

}  // namespace catoptric::design
