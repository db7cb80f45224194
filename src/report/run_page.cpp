#include "report/run_page.h"

#include <fmt/format.h>

#include "base/units.h"
#include "design/constraints.h"
#include "design/metrics.h"
#include "report/field_report.h"
#include "report/html_report.h"
#include "report/intensity_report.h"
#include "report/page_tables.h"
#include "report/result_json.h"
#include "report/run_tables.h"
#include "report/sensitivity_report.h"
#include "report/verdict.h"

namespace catoptric::report {
namespace {

std::string kernel_text(const design::Scene& scene, const design::Judgement& judgement) {
  if (judgement.kernel_radius_mm == 0)
    return fmt::format("none: the {} itself", irradiance_name(scene.source.quantity));
  const std::string radius =
      fmt::format("radius {:.4g} {}", scene.to_scene_unit(judgement.kernel_radius_mm), symbol(scene.unit));
  if (judgement.accuracy)
    return fmt::format("{}, bias of order {}; what it blurs is within the error stated", radius,
                       judgement.accuracy->order);
  return fmt::format("{}, {}", sim::name(scene.model.estimate.kernel), radius);
}

/// How every figure on the page was judged.
std::vector<Fact> measure_facts(const design::Scene& scene, const design::Judgement& judgement) {
  std::vector<Fact> facts;
  if (judgement.accuracy) facts.emplace_back("Accuracy", judgement.accuracy->sentence);
  if (judgement.rung == sim::Rung::tubes)
    facts.emplace_back("Light", "ray tubes, no random numbers");
  else
    facts.emplace_back(
        "Photons",
        fmt::format("{} replicates of {} ({}), rung {}", judgement.replicates, judgement.photons,
                    scene.model.photons.sampler == sim::Sampler::sobol ? "Sobol, scrambled" : "random",
                    name(judgement.rung)));
  facts.emplace_back("Kernel", kernel_text(scene, judgement));
  facts.emplace_back("Samples",
                     fmt::format("{}; near field of {}", samples_text(scene, judgement.reflected.size()),
                                 area_text(scene, scene.near_field.area_mm2())));
  const std::string irradiance = printed(irradiance_unit(scene.source.quantity));
  facts.emplace_back("Noise of one evaluation, rms",
                     fmt::format("{:.2g} {}", to_w_per_m2(judgement.field_noise_w_per_mm2), irradiance));
  facts.emplace_back("Kernel bias of the field, rms",
                     fmt::format("{:.2g} {}", to_w_per_m2(judgement.field_bias_w_per_mm2), irradiance));
  return facts;
}

PageSection light_section(const design::Scene& scene, const design::Judged& judged,
                          const std::vector<DrawnFigure>& figures) {
  const bool luminous = scene.source.quantity == LightQuantity::luminous;
  return {luminous ? "Illuminance on the near field" : "Irradiance on the near field",
          scene.target.notes,
          {},
          {{"", field_table(scene, judged.judgement)}},
          picked(figures, {"radial", "irradiance-result", "irradiance-target", "irradiance-start"})};
}

PageSection figures_section(const design::Scene& scene, const design::Judged& found,
                            const design::Judged* start) {
  PageSection section{
      "Noise and bias",
      {"Noise is the standard error over independent replicates. Bias is what the kernel's blur and "
       "the photons' noise add to a figure: the truth is near the figure less its bias."},
      measure_facts(scene, found.judgement),
      {{"", figures_table(scene, found, start)}},
      {}};
  if (!found.constraints.empty())
    section.tables.push_back({"Constraints", constraint_table(scene, found.constraints)});
  Table energy = energy_table(scene, found);
  if (!energy.rows.empty()) section.tables.push_back({"Where the light went", std::move(energy)});
  return section;
}

/// What becomes of the light that meets the mirror.
std::string mirror_words(const sim::Material& mirror) {
  std::string words = mirror.by_angle ? fmt::format("{:.4g} to {:.4g} (head-on, at 60 degrees of incidence)",
                                                    mirror.reflectance_at(1), mirror.reflectance_at(0.5))
                                      : fmt::format("{:.4g}", mirror.reflectance);
  words += mirror.roughness > 0 && mirror.reflectance > 0
               ? fmt::format(" is reflected by microfacets of roughness {:.4g}", mirror.roughness)
               : " is reflected specularly";
  if (mirror.diffuse > 0) words += fmt::format(", {:.4g} diffusely", mirror.diffuse);
  return words + fmt::format(", {:.4g} passes", mirror.transmittance);
}

std::string left_out_of_the_model(const design::Scene& scene) {
  std::string text = "Left out: ";
  text += sim::is_specular(scene.mirror) ? "scattering at the mirror, "
          : scene.mirror.roughness > 0   ? "light between two microfacets, "
                                         : "";
  text += "errors of the mirror's shape as it is made, colour, polarisation, and all surroundings but ";
  return text + (scene.surroundings ? "those that the scene names." : "the near field.");
}

/// What the model holds and what it does not, so that nobody reads more into the figures.
PageSection model_section(const design::Scene& scene, const sim::Plan& plan,
                          const design::Judgement& judgement, const std::vector<std::string>& not_shown) {
  PageSection section{"What was modelled", {}, {}, {}, {}};
  for (const sim::Finding& finding : plan.findings)
    section.facts.emplace_back(finding.feature, finding.found + ": " + finding.consequence);
  section.paragraphs = {
      fmt::format(
          "Light from the source meets the true surface of revolution (engine {}); of it {} and the rest is "
          "absorbed, as often as it meets it. Direct light is computed, with the mirror's shadow.",
          name(scene.model.engine), mirror_words(scene.mirror)),
      left_out_of_the_model(scene)};
  if (judgement.kernel_radius_mm > 0 && !judgement.accuracy)
    section.paragraphs.emplace_back(
        "The kernel's bias is extrapolated from two bandwidths; at jumps of the field (the rim of a beam, a "
        "fold) "
        "it is underestimated.");
  for (const std::string& sentence : not_shown) section.paragraphs.push_back("Not on this page. " + sentence);
  return section;
}

/// Nothing where there is no intensity.
std::vector<PageSection> far_sections(const design::Illustration& illustration,
                                      const std::vector<DrawnFigure>& figures) {
  if (!illustration.intensity) return {};
  return {intensity_section(*illustration.intensity, picked(figures, {"intensity-polar"}))};
}

std::vector<PageSection> tolerance_sections(const design::Illustration& illustration) {
  if (!illustration.sensitivity) return {};
  return {tolerance_section(*illustration.sensitivity)};
}

PageSection search_section(const design::Scene& scene, const design::DesignResult& result,
                           const std::vector<DrawnFigure>& figures) {
  PageSection section{"The search", {result.search.sentence}, {}, {}, {}};
  section.facts = {{"Method", scene.search.method},
                   {"Light by", std::string(name(result.plan.rung))},
                   {"Counts", fmt::format("{} evaluations, {} iterations, {} successes, {} restarts",
                                          result.search.evaluations, result.search.iterations,
                                          result.search.successes, result.search.restarts)}};
  section.figures = picked(figures, {"convergence", "contours", "landscape"});
  Table iterates = convergence_table(scene, result);
  const std::string words =
      fmt::format("Iterates ({}; all of them with all digits are in convergence.csv)", iterates.rows.size());
  section.tables = {{"", shortened(std::move(iterates)), words}};
  return section;
}

void append(std::vector<PageSection>& all, std::vector<PageSection> more) {
  for (PageSection& section : more) all.push_back(std::move(section));
}

}  // namespace

std::string design_page(const design::Scene& scene, const design::DesignResult& result,
                        const design::Illustration& illustration, const std::vector<DrawnFigure>& figures) {
  Page page = page_of(scene, "design");
  page.subtitle = verdict(scene, result);
  const std::string metric = design::objective_name(scene.search.metric),
                    unit = design::objective_unit(scene);
  page.facts = {{"Outcome", outcome_word(result)},
                {metric + " of the result", figure_text(result.best.judgement.objective, unit)},
                {metric + " of the start", figure_text(result.start.judgement.objective, unit)},
                {"Effort", fmt::format("{} evaluations in {} iterations, {} photons, {:.1f} s",
                                       result.search.evaluations, result.search.iterations, result.photons,
                                       result.seconds)}};
  if (!result.best.constraints.empty())
    page.facts.emplace_back("Constraints", design::sentence(result.best.constraints, scene.unit));
  page.sections = {
      mirror_section(scene, result.best.profile, result.best.source, illustration.paths, figures),
      light_section(scene, result.best, figures), figures_section(scene, result.best, &result.start)};
  append(page.sections, far_sections(illustration, figures));
  page.sections.push_back(search_section(scene, result, figures));
  append(page.sections, tolerance_sections(illustration));
  page.sections.push_back(model_section(scene, result.plan, result.best.judgement, illustration.left_out));
  page.sections.push_back(again_section(scene, "design"));
  return html_page(page);
}

std::string simulation_page(const design::Scene& scene, const design::SimulationResult& result,
                            const design::Illustration& illustration,
                            const std::vector<DrawnFigure>& figures) {
  Page page = page_of(scene, "simulate");
  page.subtitle = verdict(scene, result);
  const design::Judgement& judgement = result.mirror.judgement;
  if (judgement.has_objective)
    page.facts.emplace_back(design::objective_name(scene.search.metric),
                            figure_text(judgement.objective, design::objective_unit(scene)));
  page.facts.emplace_back("Effort", fmt::format("{} photons, {:.1f} s", result.photons, result.seconds));
  if (!result.mirror.constraints.empty())
    page.facts.emplace_back("Constraints", design::sentence(result.mirror.constraints, scene.unit));
  page.sections = {
      mirror_section(scene, result.mirror.profile, result.mirror.source, illustration.paths, figures),
      light_section(scene, result.mirror, figures), figures_section(scene, result.mirror, nullptr)};
  append(page.sections, far_sections(illustration, figures));
  append(page.sections, tolerance_sections(illustration));
  page.sections.push_back(model_section(scene, result.plan, judgement, illustration.left_out));
  page.sections.push_back(again_section(scene, "simulate"));
  return html_page(page);
}

std::string study_page(const design::Study& study, const std::vector<StudyRow>& rows, double seconds,
                       const std::vector<DrawnFigure>& figures) {
  Page page{study.title, verdict(rows), {}, {}, "catoptric " + version()};
  page.origin = fmt::format("catoptric study ({} of each run) · version {}",
                            study.designs ? "design" : "simulate", version());
  page.facts = {{"Runs", fmt::format("{}", study.runs.size())}, {"Time", fmt::format("{:.1f} s", seconds)}};
  PageSection table{"Runs", {"One row per run; figures from elsewhere stand beside ours."}, {}, {}, {}};
  Table shown = study_table(rows);
  for (Column& column : shown.columns) {
    const bool is_error = column.name.starts_with("noise") || column.name.starts_with("bias");
    column.digits = is_error ? 2 : 5;
  }
  table.tables = {{"", std::move(shown)}};
  PageSection reports{
      "The runs' own reports", {"Each run has a folder of its own with its files."}, {}, {}, {}};
  for (const StudyRow& row : rows) {
    if (row.error.empty())
      reports.links.emplace_back("Run " + row.run.name, row.run.name + "/report.html");
    else
      reports.facts.emplace_back("Run " + row.run.name + " failed", row.error);
  }
  page.sections = {table, {"Pictures", {}, {}, {}, picked(figures)}, reports};
  return html_page(page);
}

}  // namespace catoptric::report
