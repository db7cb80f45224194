#pragma once

#include <filesystem>

#include "design/tradeoff.h"
#include "report/run_files.h"
#include "report/table.h"

namespace catoptric::report {

/// One row per setting; times in s, errors relative to the field's root mean square.
Table trade_table(const design::Scene& scene, const design::Tradeoff& trade);

/// The settings that no other beats, cheapest first, in words.
Table front_table(const design::Scene& scene, const design::Tradeoff& trade);

/// `tradeoff.csv`, `tradeoff.json`, the plot, `report.html`, `scene.toml`.
/// @fails IoError
WrittenFiles write_tradeoff(const design::Scene& scene, const design::Tradeoff& trade,
                            const std::filesystem::path& folder);

}  // namespace catoptric::report
