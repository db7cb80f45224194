#pragma once

#include <string>
#include <vector>

#include "design/run.h"
#include "report/run_files.h"

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

}  // namespace catoptric::report
