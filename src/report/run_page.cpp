#include "report/run_page.h"

#include <fmt/format.h>

#include "base/units.h"
#include "design/metrics.h"
#include "report/field_report.h"
#include "report/html_report.h"
#include "report/result_json.h"
#include "report/run_tables.h"

namespace catoptric::report {
namespace {

std::string length_unit(const design::Scene& scene) { return std::string(symbol(scene.unit)); }

std::string objective_text(const design::Scene& scene, const design::Judgement& judgement) {
  std::string unit = printed(design::objective_unit(scene));
  if (!unit.empty()) unit.insert(0, " ");
  const design::Figure& figure = judgement.objective;
  return fmt::format("{:.5g}{} (noise ± {:.2g}, bias {:+.2g}{})", figure.value, unit, figure.noise,
                     figure.bias, unit);
}

std::string kernel_text(const design::Scene& scene, const design::Judgement& judgement) {
  if (judgement.kernel_radius_mm == 0)
    return fmt::format("none: the {} itself", irradiance_name(scene.source.quantity));
  const std::string radius =
      fmt::format("radius {:.4g} {}", scene.to_scene_unit(judgement.kernel_radius_mm), length_unit(scene));
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
  facts.emplace_back(
      "Samples", fmt::format("{}; near field of {:.4g} mm²", samples_text(scene, judgement.reflected.size()),
                             scene.near_field.area_mm2()));
  const std::string irradiance = printed(irradiance_unit(scene.source.quantity));
  facts.emplace_back("Noise of one evaluation, rms",
                     fmt::format("{:.3g} {}", to_w_per_m2(judgement.field_noise_w_per_mm2), irradiance));
  facts.emplace_back("Kernel bias of the field, rms",
                     fmt::format("{:.3g} {}", to_w_per_m2(judgement.field_bias_w_per_mm2), irradiance));
  return facts;
}

PageSection figure_section(const std::string& heading, const std::vector<DrawnFigure>& figures) {
  PageSection section{heading, {}, {}, {}, {}};
  for (const DrawnFigure& figure : figures)
    section.figures.push_back(
        {figure.caption, figure.svg, "not drawn; its data is in figures/" + figure.name + ".gp"});
  return section;
}

/// Nothing where nothing binds.
std::vector<PageTable> constraint_tables(const design::Scene& scene, const design::Judged& judged) {
  if (judged.constraints.empty()) return {};
  return {{"Constraints", constraint_table(scene, judged.constraints)}};
}

PageSection mirror_section(const design::Scene& scene, const Profile& profile) {
  Table points{{{"control point", ""},
                {"r", length_unit(scene), 10},
                {"z", length_unit(scene), 10},
                {"weight", "", 10}},
               {}};
  for (std::size_t i = 0; i < profile.points().size(); ++i) {
    const ControlPoint& point = profile.points()[i];
    points.rows.push_back({static_cast<long long>(i), scene.to_scene_unit(point.r_mm),
                           scene.to_scene_unit(point.z_mm), point.weight});
  }
  std::string knots;
  for (double knot : profile.knots()) knots += fmt::format("{}{:.10g}", knots.empty() ? "" : ", ", knot);
  return {
      "The mirror",
      scene.profile_notes,
      {{"Degree", fmt::format("{}", profile.degree())},
       {"Knots", knots},
       {"Rim radius", fmt::format("{:.8g} {}", scene.to_scene_unit(profile.at(profile.last_parameter()).r_mm),
                                  length_unit(scene))},
       {"Depth", fmt::format("{:.8g} {}", scene.to_scene_unit(profile.z_max_mm() - profile.z_min_mm()),
                             length_unit(scene))},
       {"Area", fmt::format("{:.8g} mm²", profile.area_mm2())}},
      {{"Control points", points}},
      {}};
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

/// What the model holds and what it does not, so that nobody reads more into the figures.
PageSection model_section(const design::Scene& scene, const sim::Plan& plan) {
  PageSection section{"What was modelled", {}, {}, {}, {}};
  for (const sim::Finding& finding : plan.findings)
    section.facts.emplace_back(finding.feature, finding.found + ": " + finding.consequence);
  section.paragraphs = {
      fmt::format(
          "Light from the source meets the true surface of revolution (engine {}); of it {} and the rest is "
          "absorbed, as often as it meets it. Direct light is computed, with the mirror's shadow.",
          name(scene.model.engine), mirror_words(scene.mirror)),
      std::string("Left out: ") +
          (sim::is_specular(scene.mirror) ? "scattering" : "light between two microfacets") +
          " and the mirror's figure error, colour, polarisation, and all surroundings but "
          "the near field. The kernel's bias is extrapolated from two bandwidths; at jumps of "
          "the "
          "field (the rim of a beam, a fold) it is underestimated."};
  return section;
}

std::string footer(const design::Scene& scene, const char* command) {
  return fmt::format("catoptric {} · seed {} · run again with: catoptric {} scene.toml", version(),
                     scene.seed, command);
}

std::string title_of(const design::Scene& scene) {
  return scene.title.empty() ? scene.settings.file() : scene.title;
}

}  // namespace

std::string design_page(const design::Scene& scene, const design::DesignResult& result,
                        const std::vector<DrawnFigure>& figures) {
  Page page{title_of(scene), result.search.sentence, {}, {}, footer(scene, "design")};
  const std::string metric = design::objective_name(scene.search.metric);
  page.facts = {{"Outcome", outcome_word(result)},
                {metric + " of the result", objective_text(scene, result.best.judgement)},
                {metric + " of the start", objective_text(scene, result.start.judgement)},
                {"Effort", fmt::format("{} evaluations in {} iterations, {} photons, {:.1f} s",
                                       result.search.evaluations, result.search.iterations, result.photons,
                                       result.seconds)}};
  if (!result.best.constraints.empty())
    page.facts.emplace_back("Constraints", design::sentence(result.best.constraints, scene.unit));
  std::vector<PageTable> tables{{"", summary_table(scene, result)},
                                {"The result's light", field_table(scene, result.best.judgement)}};
  for (PageTable& table : constraint_tables(scene, result.best)) tables.push_back(std::move(table));
  page.sections = {
      {"Start and result",
       scene.target.notes,
       measure_facts(scene, result.best.judgement),
       std::move(tables),
       {}},
      figure_section("Pictures", figures),
      mirror_section(scene, result.best.profile),
      model_section(scene, result.plan),
      {"Search", {}, {}, {{"Iterates", convergence_table(scene, result)}}, {}},
  };
  return html_page(page);
}

std::string simulation_page(const design::Scene& scene, const design::SimulationResult& result,
                            const std::vector<DrawnFigure>& figures) {
  Page page{title_of(scene), "The scene as it stands", {}, {}, footer(scene, "simulate")};
  if (result.mirror.judgement.has_objective)
    page.facts.push_back(
        {design::objective_name(scene.search.metric), objective_text(scene, result.mirror.judgement)});
  page.facts.push_back({"Effort", fmt::format("{} photons, {:.1f} s", result.photons, result.seconds)});
  std::vector<PageTable> tables{{"", simulation_table(scene, result)},
                                {"Its light", field_table(scene, result.mirror.judgement)}};
  for (PageTable& table : constraint_tables(scene, result.mirror)) tables.push_back(std::move(table));
  page.sections = {{"Figures of the scene",
                    scene.target.notes,
                    measure_facts(scene, result.mirror.judgement),
                    std::move(tables),
                    {}},
                   figure_section("Pictures", figures),
                   mirror_section(scene, result.mirror.profile),
                   model_section(scene, result.plan)};
  return html_page(page);
}

std::string study_page(const design::Study& study, const Table& table, double seconds) {
  Page page{study.title,
            "A study: one row per run, figures from elsewhere beside ours",
            {},
            {},
            "catoptric " + version()};
  page.facts = {{"Runs", fmt::format("{}", study.runs.size())}, {"Time", fmt::format("{:.1f} s", seconds)}};
  page.sections = {
      {"Runs", {"Each run has a folder of its own with its report and files."}, {}, {{"", table}}, {}}};
  return html_page(page);
}

}  // namespace catoptric::report
