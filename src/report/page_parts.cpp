#include "report/page_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/units.h"
#include "report/page_tables.h"
#include "report/result_json.h"
#include "report/run_view.h"

namespace catoptric::report {
namespace {

PageFigure on_page(const DrawnFigure& figure) {
  return {figure.caption, figure.svg, "not drawn; its data is in figures/" + figure.name + ".gp"};
}

std::string length_text(const design::Scene& scene, double mm) {
  return fmt::format("{:.6g} {}", scene.to_scene_unit(mm), symbol(scene.unit));
}

/// A thin sheet's: area times thickness.
std::string mass_text(const design::Scene& scene, const Profile& profile) {
  const double g = profile.area_mm2() * scene.sheet_mm * scene.density_kg_per_m3 * 1e-6;
  return fmt::format(
      "{} as a sheet of {:.4g} {} at {:.5g} kg/m³ (area × thickness; keys reflector.sheet and "
      "reflector.density)",
      g < 1000 ? fmt::format("{:.3g} g", g) : fmt::format("{:.3g} kg", g / 1000),
      scene.to_scene_unit(scene.sheet_mm), symbol(scene.unit), scene.density_kg_per_m3);
}

std::string knots_text(const Profile& profile) {
  std::string knots;
  for (const double knot : profile.knots())
    knots += fmt::format("{}{:.10g}", knots.empty() ? "" : ", ", knot);
  return knots;
}

}  // namespace

std::string area_text(const design::Scene& scene, double mm2) {
  return fmt::format("{:.6g} {}²", scene.to_scene_unit(scene.to_scene_unit(mm2)), symbol(scene.unit));
}

Page page_of(const design::Scene& scene, std::string_view command) {
  Page page{};
  page.title = scene.title.empty() ? scene.settings.file() : scene.title;
  page.origin =
      fmt::format("catoptric {} of scene {} · version {}", command, scene.settings.file(), version());
  page.footer = fmt::format("catoptric {} · seed {} · run again with: catoptric {} scene.toml", version(),
                            scene.seed, command);
  return page;
}

std::vector<PageFigure> picked(const std::vector<DrawnFigure>& figures,
                               const std::vector<std::string_view>& names) {
  std::vector<PageFigure> list;
  for (const std::string_view name : names)
    for (const DrawnFigure& figure : figures)
      if (figure.name == name) list.push_back(on_page(figure));
  return list;
}

std::vector<PageFigure> picked(const std::vector<DrawnFigure>& figures) {
  std::vector<PageFigure> list;
  std::transform(figures.begin(), figures.end(), std::back_inserter(list), on_page);
  return list;
}

PageSection mirror_section(const design::Scene& scene, const Profile& profile,
                           const design::SourceSpec& source, const std::vector<sim::LightPath>& paths,
                           const std::vector<DrawnFigure>& figures) {
  PageSection section{"The mirror", scene.profile_notes, {}, {}, picked(figures, {"generatrix"})};
  section.view = view_of(scene, profile, source, paths);
  section.facts = {{"Rim radius", length_text(scene, profile.at(profile.last_parameter()).r_mm)},
                   {"Depth", length_text(scene, profile.z_max_mm() - profile.z_min_mm())},
                   {"Area", area_text(scene, profile.area_mm2())},
                   {"Mass", mass_text(scene, profile)},
                   {"Degree", fmt::format("{}", profile.degree())},
                   {"Knots", knots_text(profile)}};
  section.tables = {
      {"Control points of the generatrix, from the apex to the rim", control_point_table(scene, profile)}};
  return section;
}

PageSection again_section(const design::Scene& scene, std::string_view command) {
  PageSection section{"To run it again", {}, {}, {}, {}};
  section.facts = {{"Command", fmt::format("catoptric {} scene.toml", command)},
                   {"Version", version()},
                   {"Seed", fmt::format("{}", scene.seed)}};
  section.listings = {{"scene.toml: the scene with all defaults written out", design::scene_text(scene)}};
  return section;
}

}  // namespace catoptric::report
