#pragma once

#include <optional>
#include <string>
#include <vector>

#include "design/luminaire.h"
#include "design/run.h"
#include "design/sensitivity.h"
#include "sim/light_paths.h"

namespace catoptric::design {

/// What a report shows beside the verdict. Pictures and side figures: by fewer photons than the verdict, on
/// streams of their own, and by the engine `meridian`, so that none of it takes long.
struct Illustration {
  std::vector<sim::LightPath> paths;            ///< that met the mirror; few
  std::optional<LuminaireIntensity> intensity;  ///< source and mirror from afar
  std::optional<Landscape> landscape;           ///< about the search's path
  std::optional<Sensitivity> sensitivity;
  std::vector<std::string> left_out;  ///< which of these are not there, and why, in sentences
};

/// Some ways of light over the mirror of a scene as it stands, by the photons of a stream of their own.
/// @fails InputError
std::vector<sim::LightPath> shown_paths(const Scene& scene);

/// Of a scene as it stands: ways of light, intensity, and tolerances where ray tubes make them cheap.
/// @in    its variables at their starts
/// @fails never for light that cannot be computed: that is left out and said
/// @cost  some tenths of a second
Illustration illustrate(const Scene& scene);

/// Of a design: the same of the mirror found, and the objective about the search's path where ray tubes
/// carried a search of one or two listed variables. With more variables there is no one picture, and by
/// photons it would take longer than the search.
Illustration illustrate(const Scene& scene, const DesignResult& result);

}  // namespace catoptric::design
