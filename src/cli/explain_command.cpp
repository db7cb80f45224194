#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/json_lines.h"
#include "design/evaluator.h"
#include "design/memory_need.h"
#include "design/run.h"
#include "design/shared_work.h"

namespace catoptric::cli {

namespace {

void print_plan(const char* title, const sim::Plan& plan) {
  fmt::print("{}\n", title);
  for (const sim::Finding& finding : plan.findings)
    fmt::print("  {:<22}  {}: {}\n", finding.feature, finding.found, finding.consequence);
}

void print_sharing(const design::Scene& scene, const std::optional<sim::Plan>& searched, const Ranks& ranks) {
  std::optional<sim::Rung> rung;
  if (searched) rung = searched->rung;
  const std::string shared = design::sharing_sentence(scene, rung, ranks);
  if (!shared.empty()) fmt::print("  {:<22}  {}\n", "ranks", shared);
}

}  // namespace

ExitCode explain_command(const CommonOptions& options) {
  const design::Scene scene = design::read_scene(options.input, options.overrides());
  const design::Candidate start = design::start_candidate(scene);
  const sim::Plan shown = design::simulation_plan(scene, start);
  if (options.json) {
    json_plan("simulate", shown);
    if (!scene.variables.empty()) json_plan("search", design::make_plan(scene, design::family_of(scene)));
    return ExitCode::done;
  }
  print_plan("simulate computes the light so:", shown);
  if (scene.accuracy_rel)
    fmt::print("  {:<22}  photons and bandwidth are found until the relative error is at most {:g} (95 %)\n",
               "accuracy", *scene.accuracy_rel);
  for (const std::string& note : scene.target.notes) fmt::print("  {:<22}  {}\n", "target", note);
  fmt::print("  {:<22}  {}\n", "memory", design::memory_need(scene, options.ranks->size()).sentence);
  std::optional<sim::Plan> search_plan;
  if (!scene.variables.empty()) search_plan = design::make_plan(scene, design::family_of(scene));
  print_sharing(scene, search_plan, *options.ranks);
  if (search_plan) {
    const sim::Plan& searched = *search_plan;
    if (searched.rung == shown.rung)
      fmt::print("\ndesign and landscape search with the same rung, {}\n", name(searched.rung));
    else
      print_plan("\ndesign and landscape search so:", searched);
    fmt::print(
        "  {:<22}  photons on fresh random numbers, with noise and bias, whatever the rung of the search\n",
        "verdict");
  }
  return ExitCode::done;
}

}  // namespace catoptric::cli
