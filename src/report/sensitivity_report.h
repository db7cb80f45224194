#pragma once

#include "design/sensitivity.h"
#include "report/html_report.h"
#include "report/run_files.h"
#include "report/table.h"

namespace catoptric::report {

/// The maker's table: for each deviation what it costs, what may be allowed of it alone, and in a budget of
/// equal shares.
Table tolerance_table(const design::Sensitivity& sensitivity);

/// One row per radius: the field, and for each deviation the derivative with its noise.
Table derivative_table(const design::Scene& scene, const design::Sensitivity& sensitivity);

/// What the budget says, in a sentence.
std::string budget_sentence(const design::Sensitivity& sensitivity);

/// The same for another command's page: the table's main columns, and what each deviation is.
PageSection tolerance_section(const design::Sensitivity& sensitivity);

/// `sensitivity.csv`, `derivatives.csv`, `sensitivity.json`, `scene.toml`, `report.html` and the plots.
WrittenFiles write_sensitivity(const design::Scene& scene, const design::Sensitivity& sensitivity,
                               const std::filesystem::path& folder);

}  // namespace catoptric::report
