#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "design/run.h"
#include "design/study.h"

namespace catoptric::report {

/// The program's version and the commit it was built from.
std::string version();

/// `result.json` of a design; keys are documented in src/report/README.md.
nlohmann::ordered_json result_json(const design::Scene& scene, const design::DesignResult& result);

/// `result.json` of a simulation: the same without search.
nlohmann::ordered_json result_json(const design::Scene& scene, const design::SimulationResult& result);

/// The word for an ending that other programs may test: "converged", "unconverged" or "interrupted".
std::string outcome_word(optim::Ending ending);
/// The same for a design, which may also be "unsatisfied": the search converged and its result breaks
/// constraints.
std::string outcome_word(const design::DesignResult& result);

/// Pretty text of a JSON value with a final newline; NaN and infinity become null.
std::string json_text(const nlohmann::ordered_json& value);

}  // namespace catoptric::report
