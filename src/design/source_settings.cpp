#include "design/source_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "design/ray_bundle.h"
#include "photometry/intensity_file.h"

namespace catoptric::design {
namespace {

void refuse(const Settings& settings, const char* path, const char* why) {
  if (settings.has(path)) throw settings.error(path, "does not belong to this source", why, "remove it");
}

const std::map<std::string, SourceKind> source_kinds{
    {"point", SourceKind::point},   {"disc", SourceKind::disc},         {"rectangle", SourceKind::rectangle},
    {"sphere", SourceKind::sphere}, {"cylinder", SourceKind::cylinder}, {"intensity", SourceKind::intensity},
    {"rays", SourceKind::rays}};

/// A key that belongs to some kinds alone.
struct SourceKey {
  const char* path;
  std::vector<std::string> kinds;
  const char* why_not;
  bool is_needed;
};
const SourceKey source_keys[] = {
    {"source.exponent", {"point"}, "a surface radiates by Lambert's law", false},
    {"source.radius",
     {"disc", "sphere", "cylinder"},
     "a point has no size, a rectangle width and height",
     true},
    {"source.length", {"cylinder"}, "only a cylinder has one", true},
    {"source.width", {"rectangle"}, "only a rectangle has one", true},
    {"source.height", {"rectangle"}, "only a rectangle has one", true},
    {"source.along",
     {"rectangle", "intensity", "rays"},
     "light that is alike round its axis has no other",
     false},
    {"source.file", {"intensity", "rays"}, "only what was measured is in a file", true},
};

/// The light of a file that says how much it is, unless the scene does.
void fill_flux_of_file(Settings& settings, const std::string& kind) {
  if (settings.has("source.power") || settings.has("source.flux")) return;
  const std::string file = *settings.text("source.file");
  if (kind == "rays") {
    const RayFileLight light = read_rays(file, {});
    settings.fill(power_key(light.quantity), fmt::format("{}", light.flux));
  } else {
    const IntensityTable table = photometry::read_intensity(file).table;
    settings.fill(power_key(table.quantity()), fmt::format("{}", table.flux()));
  }
}

void require_one_power(const Settings& settings) {
  if (settings.has("source.power") && settings.has("source.flux"))
    throw settings.error("source.flux", "stands beside source.power",
                         "a scene is in W or in lm, and none is turned into the other without a spectrum",
                         "remove one of them");
  if (!settings.has("source.power") && !settings.has("source.flux"))
    throw settings.error("source.power", "is missing", "a source needs its power in W or its flux in lm",
                         "source.power = 1.0, or source.flux = 1000.0");
}

}  // namespace

const char* power_key(LightQuantity quantity) {
  return quantity == LightQuantity::luminous ? "source.flux" : "source.power";
}

void complete_source(Settings& settings) {
  const std::string kind = *settings.text("source.kind");
  for (const SourceKey& key : source_keys) {
    const bool owned = std::ranges::find(key.kinds, kind) != key.kinds.end();
    if (!owned) refuse(settings, key.path, key.why_not);
    if (owned && key.is_needed && !settings.has(key.path))
      throw settings.error(key.path, "is missing", fmt::format("a {} needs it", kind),
                           fmt::format("{} = {}", key.path,
                                       kind == "intensity" ? "\"lamp.ies\""
                                       : kind == "rays"    ? "\"lamp.tm25ray\""
                                                           : "5"));
  }
  const bool from_file = kind == "intensity" || kind == "rays";
  if (from_file) {
    settings.make_absolute("source.file");
    fill_flux_of_file(settings, kind);
  }
  require_one_power(settings);
  const bool point = kind == "point";
  if (point) settings.fill("source.exponent", "0.0");
  if (kind == "rectangle" || from_file) settings.fill("source.along", "[1.0, 0.0, 0.0]");
  const bool even = kind == "sphere" || (point && !(*settings.number("source.exponent") > 0) &&
                                         !settings.has("variables.source.exponent.step"));
  if (even)
    refuse(settings, "source.axis",
           point ? "with exponent 0 light is the same in all directions" : "a sphere has none");
  else
    settings.fill("source.axis", "[0.0, 0.0, 1.0]");
}

SourceSpec source_spec(const Settings& settings, double unit_mm) {
  const auto vector = [&](const char* path) {
    const Numbers v = *settings.numbers(path);
    return Vector3(v[0], v[1], v[2]);
  };
  const auto length = [&](const char* path) { return settings.number(path).value_or(0) * unit_mm; };
  const LightQuantity quantity =
      settings.has("source.flux") ? LightQuantity::luminous : LightQuantity::radiant;
  SourceSpec spec{unit_mm * vector("source.position"), *settings.number(power_key(quantity))};
  spec.quantity = quantity;
  spec.kind = source_kinds.at(*settings.text("source.kind"));
  spec.exponent = settings.number("source.exponent").value_or(0);
  spec.radius_mm = length("source.radius");
  spec.length_mm = length("source.length");
  spec.width_mm = length("source.width");
  spec.height_mm = length("source.height");
  if (settings.has("source.axis")) {
    spec.axis = vector("source.axis");
    require_direction(settings, "source.axis", spec.axis);
  }
  if (settings.has("source.along")) {
    spec.along = vector("source.along");
    require_direction(settings, "source.along", spec.along);
    constexpr double least_sine = 1e-6;
    if (!(spec.along.normalized().cross(spec.axis.normalized()).norm() > least_sine))
      throw settings.error("source.along", "is no direction across the source's axis",
                           "it is that of source.axis", "[1, 0, 0] under an axis along z");
  }
  if (spec.kind == SourceKind::intensity)
    spec.table = std::make_shared<const IntensityTable>(
        photometry::read_intensity(*settings.text("source.file")).table);
  if (spec.kind == SourceKind::rays) spec.rays = read_rays(*settings.text("source.file"), quantity).rays;
  return spec;
}

void require_direction(const Settings& settings, const char* path, const Vector3& vector) {
  constexpr double least_length = 1e-100;  // the squares of shorter ones lose digits
  if (!(vector.norm() >= least_length))
    throw settings.error(path, "has no direction", "its length is zero, or nearly", "[0, 0, 1]");
}

}  // namespace catoptric::design
