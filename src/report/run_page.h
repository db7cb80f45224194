#pragma once

#include <string>
#include <vector>

#include "design/run.h"
#include "design/study.h"
#include "report/table.h"

namespace catoptric::report {

/// A figure as it was drawn; no SVG text when it could not be.
struct DrawnFigure {
  std::string name, caption, svg;
};

/// The text of report.html for each kind of run.
std::string design_page(const design::Scene& scene, const design::DesignResult& result,
                        const std::vector<DrawnFigure>& figures);
std::string simulation_page(const design::Scene& scene, const design::SimulationResult& result,
                            const std::vector<DrawnFigure>& figures);
std::string study_page(const design::Study& study, const Table& table, double seconds);

}  // namespace catoptric::report
