#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "design/run.h"
#include "report/run_tables.h"

namespace catoptric::report {

/// What was written into a run's folder, and what could not be.
struct WrittenFiles {
  std::vector<std::string> names;
  std::vector<std::string> notes;  ///< e.g. that plots were left out since gnuplot is missing
};

/// Room on the disk that a run of the scene asks for before it begins: about twice what it writes.
std::uint64_t room_for(const design::Scene& scene);

/// `result.json`, `designed.toml` (the scene with the mirror found), `irradiance.csv`, `convergence.csv`,
/// `reflector.step`, `reflector.igs`, `reflector.dxf`, `scene.toml`, `report.html` and the plots. Each file
/// is written whole or not at all.
/// @fails CadError when an exchange file lost something, IoError
WrittenFiles write_design(const design::Scene& scene, const design::DesignResult& result,
                          const std::filesystem::path& folder);

/// The same of a scene as it stands, without search and exchange files.
WrittenFiles write_simulation(const design::Scene& scene, const design::SimulationResult& result,
                              const std::filesystem::path& folder);

/// `landscape.csv`, `paths.csv` where there are paths, contour and surface plots.
WrittenFiles write_landscape(const design::Scene& scene, const design::Landscape& landscape,
                             const std::filesystem::path& folder);

/// `study.json` (a list of results), `study.csv`, `report.html`.
WrittenFiles write_study(const design::Study& study, const std::vector<StudyRow>& rows, double seconds,
                         const std::filesystem::path& folder);

}  // namespace catoptric::report
