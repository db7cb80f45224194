#pragma once

#include <string>
#include <vector>

#include "design/luminaire.h"
#include "design/run.h"
#include "report/figures.h"
#include "report/run_tables.h"

namespace catoptric::report {

/// A figure ready to draw: its file name without extension, what it shows, and its script.
struct NamedFigure {
  std::string name;
  std::string caption;
  std::string script;
};

/// Generatrix (start, result, target), irradiance (start, result, target, on one colour scale), radial cut,
/// convergence.
std::vector<NamedFigure> design_figures(const design::Scene& scene, const design::DesignResult& result);

/// Generatrix, irradiance and radial cut of a scene as it stands.
std::vector<NamedFigure> simulation_figures(const design::Scene& scene,
                                            const design::SimulationResult& result);

/// Contours with search paths, and the surface from three sides; a line for one variable.
std::vector<NamedFigure> landscape_figures(const design::Scene& scene, const design::Landscape& landscape);

/// The generatrix of one mirror, beside the target's where a mirror is the target.
NamedFigure mirror_picture(const design::Scene& scene, const Profile& profile,
                           const design::SourceSpec& source);

/// The generatrices of a study's first mirrors, and the convergence of its first searches.
std::vector<NamedFigure> study_figures(const std::vector<StudyRow>& rows);

/// The first of the landscape's figures alone: contours, or the line, with the search paths.
NamedFigure landscape_picture(const design::Scene& scene, const design::Landscape& landscape);

/// Intensity over the angle to the axis in planes through it, 45 degrees apart: C to the right, C + 180 to
/// the left; one curve where all planes are alike.
std::vector<Curve> intensity_sections(const design::LuminaireIntensity& luminaire);

/// Intensity as a polar diagram: one plane where the light is alike all round, else four.
NamedFigure polar_picture(const design::LuminaireIntensity& luminaire);

}  // namespace catoptric::report
