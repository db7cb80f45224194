#pragma once

#include "design/luminaire.h"
#include "report/html_report.h"
#include "report/run_files.h"
#include "report/table.h"

namespace catoptric::report {

/// What a lighting engineer asks of a luminaire: flux, efficiency, peak, beam and field angle, flux by zone.
Table luminaire_table(const design::LuminaireIntensity& luminaire);

/// gamma, C, intensity, noise, bias: one row per direction.
Table intensity_table(const design::LuminaireIntensity& luminaire);

/// The main figures for another command's page, with the picture that it drew.
PageSection intensity_section(const design::LuminaireIntensity& luminaire, std::vector<PageFigure> figures);

/// `intensity.json`, `intensity.csv`, `scene.toml`, `report.html` and plots; of a scene in lm also
/// `luminaire.ies` (LM-63-2019, marked as a simulation) and `luminaire.ldt`.
WrittenFiles write_intensity(const design::Scene& scene, const design::LuminaireIntensity& luminaire,
                             const std::filesystem::path& folder);

}  // namespace catoptric::report
