#include "report/intensity_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "photometry/eulumdat.h"
#include "photometry/intensity_file.h"
#include "report/figures.h"
#include "report/page_parts.h"
#include "report/page_tables.h"
#include "report/result_json.h"
#include "report/run_figures.h"
#include "report/run_folder.h"

namespace catoptric::report {
namespace {

using Json = nlohmann::ordered_json;
using design::LuminaireIntensity;
using design::Measured;

struct Units {
  explicit Units(const LuminaireIntensity& luminaire)
      : flux(flux_unit(luminaire.table.quantity())), intensity(intensity_unit(luminaire.table.quantity())) {}
  std::string flux, intensity;
};

double efficiency(const LuminaireIntensity& luminaire) {
  return luminaire.source_flux > 0 ? luminaire.flux.value / luminaire.source_flux : 0;
}

Cell angle_cell(const std::optional<double>& angle) { return angle ? Cell{*angle} : Cell{}; }

Json measured_json(const Measured& measured, const std::string& unit) {
  return {{"value", measured.value}, {"noise", measured.noise}, {"unit", unit}};
}

Json angle_json(const std::optional<double>& angle) { return angle ? Json(*angle) : Json(nullptr); }

Json luminaire_json(const design::Scene& scene, const LuminaireIntensity& luminaire) {
  const Units unit(luminaire);
  Json zones = Json::array(), angles = Json::array();
  for (const design::ZonalFlux& zone : luminaire.zones)
    zones.push_back(
        {{"from", zone.from_deg}, {"to", zone.to_deg}, {"flux", measured_json(zone.flux, unit.flux)}});
  for (const design::BeamAngle& angle : luminaire.angles)
    angles.push_back(
        {{"c", angle.c_deg}, {"beam", angle_json(angle.half_deg)}, {"field", angle_json(angle.tenth_deg)}});
  return {{"title", scene.title},
          {"command", "intensity"},
          {"angle_unit", "degree"},
          {"beam", {luminaire.beam.x(), luminaire.beam.y(), luminaire.beam.z()}},
          {"source_flux", {{"value", luminaire.source_flux}, {"unit", unit.flux}}},
          {"flux", measured_json(luminaire.flux, unit.flux)},
          {"efficiency", efficiency(luminaire)},
          {"peak", measured_json(luminaire.peak, unit.intensity)},
          {"peak_gamma", luminaire.peak_gamma_deg},
          {"peak_c", luminaire.peak_c_deg},
          {"angles", angles},
          {"zones", zones},
          {"remark", luminaire.remark},
          {"noise_rel", luminaire.noise_rel},
          {"bias_rel", luminaire.bias_rel},
          {"photons", luminaire.photons},
          {"seconds", luminaire.seconds},
          {"seed", scene.seed},
          {"version", version()}};
}

std::vector<NamedFigure> figures(const LuminaireIntensity& luminaire) {
  const LineFigure figure{"Intensity by the angle to the axis",
                          "angle to the axis (degrees)",
                          fmt::format("intensity ({})", Units(luminaire).intensity),
                          intensity_sections(luminaire),
                          {}};
  return {{"intensity", "Intensity by the angle to the axis", line_script(figure)}};
}

photometry::Luminaire about(const design::Scene& scene, const LuminaireIntensity& luminaire) {
  photometry::Luminaire about;
  about.test = fmt::format("simulation, seed {}", scene.seed);
  about.laboratory = "catoptric " + version();
  about.issue_date = scene.intensity.issue_date;
  about.manufacturer = scene.intensity.manufacturer;
  about.name = scene.intensity.luminaire.empty() ? scene.title : scene.intensity.luminaire;
  about.lamp = scene.intensity.lamp;
  about.lamp_flux_lm = luminaire.source_flux;
  about.input_w = scene.intensity.input_w;
  about.opening.along_c0_mm = about.opening.along_c90_mm = 2 * luminaire.profile.r_max_mm();
  about.opening.is_round = true;
  return about;
}

}  // namespace

Table luminaire_table(const LuminaireIntensity& luminaire) {
  const Units unit(luminaire);
  Table table{{{"figure", ""}, {"unit", ""}, {"value", ""}, {"noise (1 sigma)", "", 2}}, {}};
  const auto row = [&](const std::string& name, const std::string& of, const Measured& measured) {
    table.rows.push_back({name, of, measured.value, measured.noise});
  };
  table.rows.push_back({"source", unit.flux, luminaire.source_flux, Cell{}});
  row("leaves the luminaire", unit.flux, luminaire.flux);
  row("efficiency", "", {efficiency(luminaire), luminaire.flux.noise / luminaire.source_flux});
  row("greatest intensity", unit.intensity, luminaire.peak);
  table.rows.push_back({"  at gamma", "degrees", luminaire.peak_gamma_deg, Cell{}});
  if (!luminaire.table.is_rotational())
    table.rows.push_back({"  at C", "degrees", luminaire.peak_c_deg, Cell{}});
  for (const design::BeamAngle& angle : luminaire.angles) {
    const std::string plane =
        luminaire.table.is_rotational() ? "" : fmt::format(", C{:g}-C{:g}", angle.c_deg, angle.c_deg + 180);
    table.rows.push_back(
        {"beam angle (above 50 %" + plane + ")", "degrees", angle_cell(angle.half_deg), Cell{}});
    table.rows.push_back(
        {"field angle (above 10 %" + plane + ")", "degrees", angle_cell(angle.tenth_deg), Cell{}});
  }
  for (const design::ZonalFlux& zone : luminaire.zones)
    row(fmt::format("gamma {:g} to {:g}", zone.from_deg, zone.to_deg), unit.flux, zone.flux);
  table.rows.push_back({"noise of the table, rms, relative", "", luminaire.noise_rel, Cell{}});
  table.rows.push_back({"its steps' bias, rms, relative", "", luminaire.bias_rel, Cell{}});
  return table;
}

Table intensity_table(const LuminaireIntensity& luminaire) {
  const std::string unit = Units(luminaire).intensity;
  Table table{{{"gamma", "degrees"}, {"C", "degrees"}, {"intensity", unit}, {"noise", unit}, {"bias", unit}},
              {}};
  const std::size_t rows = luminaire.table.gamma_deg().size();
  for (std::size_t plane = 0; plane < luminaire.table.c_deg().size(); ++plane)
    for (std::size_t i = 0; i < rows; ++i)
      table.rows.push_back({luminaire.table.gamma_deg()[i], luminaire.table.c_deg()[plane],
                            luminaire.table.value(plane, i), luminaire.noise[plane * rows + i],
                            luminaire.bias[plane * rows + i]});
  return table;
}

PageSection intensity_section(const LuminaireIntensity& luminaire, std::vector<PageFigure> figures) {
  PageSection section{"Light from afar", {}, {}, {}, std::move(figures)};
  const Units unit(luminaire);
  section.paragraphs.push_back(
      fmt::format("Source and mirror without the near field, by {} photons; catoptric intensity takes as "
                  "many as the scene says.",
                  luminaire.photons));
  section.facts = {
      {"Leaves the luminaire", measured_text(luminaire.flux.value, luminaire.flux.noise) + " " + unit.flux},
      {"Efficiency", fmt::format("{:.3g} % of the source's {:.4g} {}", 100 * efficiency(luminaire),
                                 luminaire.source_flux, unit.flux)}};
  if (!luminaire.remark.empty()) {  // then peak and angles are the table's, not the lamp's
    section.paragraphs.push_back(luminaire.remark);
    return section;
  }
  section.facts.emplace_back("Noise of the intensities",
                             fmt::format("{:.2g} %, rms", 100 * luminaire.noise_rel));
  section.facts.emplace_back("Blur by the table's steps",
                             fmt::format("{:.2g} %, rms", 100 * luminaire.bias_rel));
  section.facts.emplace_back("Greatest intensity",
                             fmt::format("{} {} at {:.3g} degrees to the axis of the beam",
                                         measured_text(luminaire.peak.value, luminaire.peak.noise),
                                         unit.intensity, luminaire.peak_gamma_deg));
  for (const design::BeamAngle& angle : luminaire.angles) {
    const std::string plane = luminaire.table.is_rotational() ? "" : fmt::format(", C{:g}", angle.c_deg);
    const auto text = [](const std::optional<double>& degrees) {
      return degrees ? fmt::format("{:.3g} degrees", *degrees) : std::string("none: it does not fall so low");
    };
    section.facts.emplace_back("Beam angle (above 50 %)" + plane, text(angle.half_deg));
    section.facts.emplace_back("Field angle (above 10 %)" + plane, text(angle.tenth_deg));
  }
  return section;
}

WrittenFiles write_intensity(const design::Scene& scene, const LuminaireIntensity& luminaire,
                             const std::filesystem::path& path) {
  RunFolder folder(path);
  folder.text("scene.toml", design::scene_text(scene));
  folder.text("intensity.json", json_text(luminaire_json(scene, luminaire)));
  folder.table("intensity.csv", intensity_table(luminaire));
  const bool fits_eulumdat = luminaire.table.gamma_deg().size() <= photometry::most_eulumdat_angles;
  if (luminaire.table.quantity() == LightQuantity::luminous) {
    for (const char* name : {"luminaire.ies", "luminaire.ldt"}) {
      if (std::string_view(name).ends_with("ldt") && !fits_eulumdat) continue;
      folder.made(name, [&](const std::filesystem::path& file) {
        photometry::write_intensity(file, luminaire.table, about(scene, luminaire));
      });
    }
    if (!fits_eulumdat)
      folder.note(
          fmt::format("no EULUMDAT file: the format has at most {} angles to the axis, the table {}; "
                      "intensity.gamma_step = 0.5 fits",
                      photometry::most_eulumdat_angles, luminaire.table.gamma_deg().size()));
  } else
    folder.note("no photometric files: these are in lm, and the scene is in W (source.flux)");
  Page page = page_of(scene, "intensity");
  page.subtitle = std::string("The luminaire from afar: source and mirror, without the near field.") +
                  (luminaire.remark.empty() ? "" : " " + luminaire.remark);
  page.facts = {
      {"Photons", fmt::format("{} replicates, {} photons in all", scene.model.replicates, luminaire.photons)},
      {"Directions", fmt::format("{} angles to the axis, {} about it", luminaire.table.gamma_deg().size(),
                                 luminaire.table.c_deg().size())},
      {"Time", fmt::format("{:.1f} s", luminaire.seconds)}};
  std::vector<NamedFigure> pictures{polar_picture(luminaire)};
  for (NamedFigure& figure : figures(luminaire)) pictures.push_back(std::move(figure));
  page.sections = {{"Figures", {}, {}, {{"", luminaire_table(luminaire)}}, picked(folder.draw_all(pictures))},
                   again_section(scene, "intensity")};
  folder.text("report.html", html_page(page));
  return folder.take();
}

}  // namespace catoptric::report
