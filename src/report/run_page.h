#pragma once

#include <string>
#include <vector>

#include "design/illustration.h"
#include "design/run.h"
#include "design/study.h"
#include "report/page_parts.h"
#include "report/run_tables.h"

namespace catoptric::report {

/// The text of report.html for each kind of run.
std::string design_page(const design::Scene& scene, const design::DesignResult& result,
                        const design::Illustration& illustration, const std::vector<DrawnFigure>& figures);
std::string simulation_page(const design::Scene& scene, const design::SimulationResult& result,
                            const design::Illustration& illustration,
                            const std::vector<DrawnFigure>& figures);
std::string study_page(const design::Study& study, const std::vector<StudyRow>& rows, double seconds,
                       const std::vector<DrawnFigure>& figures);

}  // namespace catoptric::report
