#pragma once

#include "design/run.h"
#include "design/study.h"
#include "report/table.h"

namespace catoptric::report {

/// x, y, z in the scene's unit; target, direct, reflected, total, noise in W/m^2. The target is empty without
/// one.
Table irradiance_table(const design::Scene& scene, const design::Target& target,
                       const design::Judgement& judgement);

/// Points along each generatrix: curve, parameter, r, z; 201 of each.
Table generatrix_table(const design::Scene& scene,
                       const std::vector<std::pair<std::string, Profile>>& curves);

/// One row per iterate: k, iteration, evaluations, step, move, value and the variables.
Table convergence_table(const design::Scene& scene, const design::DesignResult& result);

/// One row per point: the variables and the objective.
Table landscape_table(const design::Scene& scene, const design::Landscape& landscape);

/// One row per point of each search path: path, the variables, value.
Table paths_table(const design::Scene& scene, const design::Landscape& landscape);

/// Start beside result: variables, objective with noise and bias, all other metrics.
Table summary_table(const design::Scene& scene, const design::DesignResult& result);

/// Figures of a simulated scene: objective with noise and bias, all other metrics, energy.
Table simulation_table(const design::Scene& scene, const design::SimulationResult& result);

/// One row per constraint: limit, value, violation in the scene's units.
Table constraint_table(const design::Scene& scene, const std::vector<design::ConstraintState>& states);

/// One run of a study and what came of it; exactly one of the two results is there, or the error.
struct StudyRow {
  design::StudyRun run;
  std::optional<design::Scene> scene;
  std::optional<design::DesignResult> designed;
  std::optional<design::SimulationResult> simulated;
  std::string error;
};

/// One row per run: variables, objective with noise and bias, counts, seconds, each reference figure beside
/// ours.
Table study_table(const std::vector<StudyRow>& rows);

}  // namespace catoptric::report
