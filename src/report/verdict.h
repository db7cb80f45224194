#pragma once

#include <string>
#include <vector>

#include "design/run.h"
#include "report/run_tables.h"

namespace catoptric::report {

/// What came of a run, in a sentence or two that a person may act on: whether it went well comes first.
std::string verdict(const design::Scene& scene, const design::DesignResult& result);
std::string verdict(const design::Scene& scene, const design::SimulationResult& result);
std::string verdict(const std::vector<StudyRow>& rows);

/// "0.00335 ± 0.00003 W/m² (bias +0.0017 W/m²)"
std::string figure_text(const design::Figure& figure, const std::string& unit);

}  // namespace catoptric::report
