#include <fmt/format.h>

#include "cli/commands.h"
#include "design/evaluator.h"
#include "design/run.h"

namespace catoptric::cli {

ExitCode explain_command(const CommonOptions& options) {
  const design::Scene scene = design::read_scene(options.input, options.overrides());
  const sim::Plan plan = design::search_plan(scene, design::start_profile(scene));
  for (const sim::Finding& finding : plan.findings)
    fmt::print("{:<20}  {}: {}\n", finding.feature, finding.found, finding.consequence);
  fmt::print("{:<20}  {}\n", "verdict",
             "photons on fresh random numbers, with noise and bias, whatever the rung of the search");
  return ExitCode::done;
}

}  // namespace catoptric::cli
