#include "design/target_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "design/csv_table.h"
#include "design/picture.h"
#include "design/toml_values.h"
#include "design/wanted_intensity.h"

namespace catoptric::design {
namespace {

/// What a kind of target is written with, of the keys that not all kinds share.
struct Kind {
  std::string_view name;
  std::vector<std::string_view> needed, allowed;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> table{
      {"uniform", {"radius", "irradiance"}, {"zone_weights", "level"}},
      {"ring", {"inner_radius", "outer_radius", "irradiance"}, {"background", "zone_weights", "level"}},
      {"zones", {"radii", "irradiances"}, {"zone_weights", "level"}},
      {"gaussian", {"peak"}, {"sigma", "fwhm", "radius", "level"}},
      {"radial", {"file"}, {"column", "weight_column", "level"}},
      {"csv", {"file"}, {"column", "weight_column"}},
      {"image", {"file"}, {"width", "height", "peak", "transfer", "gamma"}},
  };
  return table;
}

constexpr std::array<std::string_view, 18> own_keys{
    "radius",       "irradiance", "inner_radius", "outer_radius", "background", "radii",
    "irradiances",  "peak",       "sigma",        "fwhm",         "scale",      "weight_column",
    "zone_weights", "level",      "width",        "height",       "transfer",   "gamma"};

bool holds(std::span<const std::string_view> list, std::string_view item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

std::string path(std::string_view key) { return "target." + std::string(key); }

void check_keys(const Settings& settings, const std::string& kind) {
  const auto found =
      std::find_if(kinds().begin(), kinds().end(), [&](const Kind& each) { return each.name == kind; });
  if (found != kinds().end())
    for (std::string_view key : found->needed)
      if (!settings.has(path(key)))
        throw settings.error(path(key), "is missing", fmt::format("a target of kind {} needs it", kind), "");
  for (std::string_view key : own_keys) {
    const bool used =
        key == "scale" ? kind != "none"
                       : found != kinds().end() && (holds(found->needed, key) || holds(found->allowed, key));
    if (!used && settings.has(path(key)))
      throw settings.error(path(key), fmt::format("does not belong to a target of kind {}", kind),
                           "it would have no effect", "remove it");
  }
}

void complete_gaussian(Settings& settings) {
  if (settings.has("target.sigma") == settings.has("target.fwhm"))
    throw settings.error("target.sigma", "a Gaussian has one width",
                         "give its standard deviation or its full width at half maximum, not both",
                         "target.fwhm = 10");
  const double sigma = settings.has("target.sigma")
                           ? *settings.number("target.sigma")
                           : *settings.number("target.fwhm") / (2 * std::sqrt(2 * std::log(2.0)));
  constexpr double sigmas = 3;  // beyond, 1.1 % of the power is left
  settings.fill("target.radius", fmt::format("{}", sigmas * sigma));
}

void check_rising(const Settings& settings, const std::string& key, const std::vector<double>& radii) {
  for (std::size_t i = 1; i < radii.size(); ++i)
    if (!(radii[i] > radii[i - 1]))
      throw settings.error(key, fmt::format("{} does not come after {}", radii[i], radii[i - 1]),
                           "radii rise from the axis outwards", "sort them");
}

void read_zones(const Settings& settings, const std::string& kind, double unit_mm, TargetSpec& spec) {
  Numbers radii, wanted;
  std::string key = "target.radii";
  if (kind == "uniform") {
    radii = {*settings.number("target.radius")};
    wanted = {*settings.number("target.irradiance")};
  } else if (kind == "ring") {
    key = "target.outer_radius";
    radii = {*settings.number("target.inner_radius"), *settings.number("target.outer_radius")};
    wanted = {*settings.number("target.background"), *settings.number("target.irradiance")};
  } else {
    radii = *settings.numbers("target.radii");
    wanted = *settings.numbers("target.irradiances");
  }
  if (radii.empty() || radii.size() != wanted.size())
    throw settings.error("target.irradiances", fmt::format("{} for {} radii", wanted.size(), radii.size()),
                         "each zone has its outer radius and its irradiance", "");
  check_rising(settings, key, radii);
  for (double radius : radii) spec.radii_mm.push_back(radius * unit_mm);
  for (double each : wanted) spec.irradiances_w_per_mm2.push_back(from_w_per_m2(each));
  spec.reach_mm = spec.radii_mm.back();
  const auto weights = settings.numbers("target.zone_weights");
  if (!weights) return;
  if (weights->size() != radii.size() + 1)
    throw settings.error("target.zone_weights",
                         fmt::format("{} weights for {} zones", weights->size(), radii.size()),
                         "one for each zone from the axis outwards, and one for what lies beyond them",
                         fmt::format("{} numbers", radii.size() + 1));
  spec.zone_weights = *weights;
}

void read_radial_table(const Settings& settings, double unit_mm, TargetSpec& spec) {
  const std::string file = spec.file.string();
  const CsvTable table = read_csv_table(spec.file);
  const auto &radii = column(table, "radius", file), &wanted = column(table, spec.column, file);
  check_range(table, radii, 0, farthest, "radius", file);
  check_range(table, wanted, 0, greatest_irradiance_w_per_m2, "irradiance", file);
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (i > 0 && !(radii[i] > radii[i - 1]))
      throw InputError({fmt::format("radius {} is out of order", radii[i]),
                        fmt::format("{}:{}", file, table.lines[i]), "radii rise from row to row",
                        "sort the table"});
    spec.radii_mm.push_back(radii[i] * unit_mm);
    spec.irradiances_w_per_mm2.push_back(from_w_per_m2(wanted[i]));
  }
  spec.reach_mm = spec.radii_mm.back();
  if (!(spec.reach_mm > 0))
    throw settings.error("target.file", "ends on the axis", "the last radius must be above 0", "");
  if (spec.weight_column.empty()) return;
  spec.table_weights = column(table, spec.weight_column, file);
  check_range(table, spec.table_weights, 0, greatest_weight_of_a_place, "weight", file);
}

void complete_intensities(Settings& settings) {
  if (settings.has("target.intensity_file")) {
    settings.make_absolute("target.intensity_file");
    settings.fill("target.intensity_resolution", "2.0");
  }
  for (const char* key : {"target.intensity_resolution", "target.intensity_scale", "target.intensity_level"})
    if (settings.has(key) && !settings.has("target.intensity_file"))
      throw settings.error(key, "stands alone", "no intensity is wanted", "target.intensity_file");
  if (settings.has("target.intensity_level") && settings.text("target.intensity_scale") == "free")
    throw settings.error("target.intensity_level", "has no effect", "the level is free", "remove it");
}

void read_intensities(const Settings& settings, TargetSpec& spec) {
  if (!settings.has("target.intensity_file")) return;
  WantedIntensity wanted = read_wanted_intensity(settings, spec.notes);
  spec.angles_rad = std::move(wanted.angles_rad);
  spec.intensities_w_per_sr = std::move(wanted.w_per_sr);
  spec.free_intensity = settings.text("target.intensity_scale") == "free";
  spec.resolution_rad = *settings.number("target.intensity_resolution") * pi / 180;
}

bool lies_across_axis(const sim::NearField& field) {
  return std::abs(std::abs(field.normal().z()) - 1) < 1e-12;  // roundings of a unit vector
}

}  // namespace

void complete_target(Settings& settings) {
  complete_intensities(settings);
  const std::string kind = *settings.text("target.kind");
  check_keys(settings, kind);
  if (kind == "ring") settings.fill("target.background", "0.0");
  if (kind == "gaussian") complete_gaussian(settings);
  if (kind == "csv" || kind == "radial") {
    settings.fill("target.column", "\"irradiance\"");
    settings.make_absolute("target.file");
  }
  if (kind == "image") complete_picture(settings);
}

TargetSpec target_spec(const Settings& settings, double unit_mm, std::optional<Profile> reference) {
  TargetSpec spec{};
  const std::string kind = *settings.text("target.kind");
  spec.free_scale = settings.text("target.scale") == "free";
  spec.reference = std::move(reference);
  spec.column = settings.text("target.column").value_or("");
  spec.weight_column = settings.text("target.weight_column").value_or("");
  spec.file = settings.text("target.file").value_or("");
  if (kind == "paraboloid") {
    spec.kind = TargetKind::paraboloid;
    spec.focal_length_mm = *settings.number("target.focal_length") * unit_mm;
    spec.rim_radius_mm = *settings.number("target.rim_radius") * unit_mm;
  } else if (kind == "reflector") {
    spec.kind = TargetKind::reflector;
  } else if (kind == "csv") {
    spec.kind = TargetKind::csv;
  } else if (kind == "image") {
    spec.kind = TargetKind::image;
    spec.picture = std::make_shared<const Picture>(read_picture(settings, unit_mm, spec.notes));
  } else if (kind == "gaussian") {
    spec.kind = TargetKind::gaussian;
    spec.peak_w_per_mm2 = from_w_per_m2(*settings.number("target.peak"));
    const auto sigma = settings.number("target.sigma"), fwhm = settings.number("target.fwhm");
    spec.sigma_mm = (sigma ? *sigma : *fwhm / (2 * std::sqrt(2 * std::log(2.0)))) * unit_mm;
    spec.reach_mm = *settings.number("target.radius") * unit_mm;
  } else if (kind == "radial") {
    spec.kind = TargetKind::radial;
    read_radial_table(settings, unit_mm, spec);
  } else if (kind != "none") {
    spec.kind = TargetKind::zones;
    read_zones(settings, kind, unit_mm, spec);
  }
  const double level = settings.number("target.level").value_or(1.0);
  for (double& each : spec.irradiances_w_per_mm2) each *= level;
  spec.peak_w_per_mm2 *= level;
  read_intensities(settings, spec);
  return spec;
}

void check_across_axis(const Settings& settings, const TargetSpec& spec, const sim::NearField& field) {
  const bool about_axis =
      spec.kind == TargetKind::zones || spec.kind == TargetKind::gaussian || spec.kind == TargetKind::radial;
  if (about_axis && !lies_across_axis(field))
    throw settings.error("target.kind", "this target does not fit a tilted near field",
                         "it is a function of the distance from the z axis", "near_field.normal = [0, 0, 1]");
}

void add_field_notes(TargetSpec& spec, const sim::NearField& field) {
  if (!spec.picture || !lies_across_axis(field)) return;
  const double off = asymmetry_rel(*spec.picture, field);
  constexpr double least_worth_telling = 1e-6;
  if (off < least_worth_telling) return;
  spec.notes.push_back(fmt::format(
      "the picture is not symmetric about the axis: {:.3g} % of its mean square is not, so that no "
      "light that is symmetric comes nearer than a relative root mean square error of {:.3g}",
      100 * off * off, off));
}

}  // namespace catoptric::design
