#include "design/source_settings.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "design/ray_bundle.h"
#include "photometry/intensity_file.h"

namespace catoptric::design {
namespace {

const std::map<std::string, SourceKind> source_kinds{
    {"point", SourceKind::point},   {"disc", SourceKind::disc},         {"rectangle", SourceKind::rectangle},
    {"sphere", SourceKind::sphere}, {"cylinder", SourceKind::cylinder}, {"intensity", SourceKind::intensity},
    {"rays", SourceKind::rays},     {"several", SourceKind::several}};

/// A key that belongs to some kinds alone.
struct SourceKey {
  const char* name;
  std::vector<std::string> kinds;
  const char* why_not;
  const char* example;  ///< of one that is needed, else null
};
const SourceKey source_keys[] = {
    {"exponent", {"point"}, "a surface radiates by Lambert's law", nullptr},
    {"radius", {"disc", "sphere", "cylinder"}, "a point has no size, a rectangle width and height", "5"},
    {"length", {"cylinder"}, "only a cylinder has one", "5"},
    {"width", {"rectangle"}, "only a rectangle has one", "5"},
    {"height", {"rectangle"}, "only a rectangle has one", "5"},
    {"along",
     {"rectangle", "intensity", "rays"},
     "light that is alike round its axis has no other direction",
     nullptr},
    {"file", {"intensity", "rays"}, "only what was measured is in a file", "\"lamp.ies\""},
};

/// The keys of one source: `source.radius`, or `sources.lamp.radius` of one among several.
class OneSource {
 public:
  OneSource(const Settings& settings, std::string prefix)
      : settings_(settings), prefix_(std::move(prefix)), is_alone_(prefix_ == "source") {}

  std::string path(const std::string& name) const { return prefix_ + "." + name; }
  bool has(const std::string& name) const { return settings_.has(path(name)); }
  std::string kind() const { return settings_.text(path("kind")).value_or("point"); }

  /// Refuses keys that do not belong to the kind, names those that are missing.
  void check_keys() const {
    for (const SourceKey& key : source_keys) {
      const bool owned = std::ranges::find(key.kinds, kind()) != key.kinds.end();
      if (!owned) refuse(key.name, key.why_not);
      if (owned && key.example && !has(key.name))
        throw settings_.error(path(key.name), "is missing",
                              fmt::format("a source of kind {} needs it", kind()),
                              fmt::format("{} = {}", path(key.name), key.example));
    }
    if (has("power") && has("flux"))
      throw settings_.error(path("flux"), "stands beside " + path("power"),
                            "a scene is in W or in lm, and none is turned into the other without a spectrum",
                            "remove one of them");
    if (is_even())
      refuse("axis",
             kind() == "point" ? "with exponent 0 light is the same in all directions" : "a sphere has none");
  }

  bool is_from_file() const { return kind() == "intensity" || kind() == "rays"; }

  /// Values that keys have when they are left out, as TOML text.
  std::vector<std::pair<std::string, std::string>> defaults() const {
    std::vector<std::pair<std::string, std::string>> list{{"kind", "\"point\""},
                                                          {"position", "[0.0, 0.0, 0.0]"}};
    if (kind() == "point") list.emplace_back("exponent", "0.0");
    if (kind() == "rectangle" || is_from_file()) list.emplace_back("along", "[1.0, 0.0, 0.0]");
    if (!is_even()) list.emplace_back("axis", "[0.0, 0.0, 1.0]");
    if (is_from_file() && !has("power") && !has("flux")) list.push_back(light_of_file());
    return list;
  }

  void require_power() const {
    if (!has("power") && !has("flux"))
      throw settings_.error(path("power"), "is missing", "a source needs its power in W or its flux in lm",
                            path("power") + " = 1.0, or " + path("flux") + " = 1000.0");
  }

  SourceSpec spec(double unit_mm) const {
    const auto length = [&](const char* name) { return settings_.number(path(name)).value_or(0) * unit_mm; };
    const LightQuantity quantity = has("flux") ? LightQuantity::luminous : LightQuantity::radiant;
    SourceSpec spec{unit_mm * vector("position"), *settings_.number(path(name_of(quantity)))};
    spec.quantity = quantity;
    spec.kind = source_kinds.at(kind());
    spec.exponent = settings_.number(path("exponent")).value_or(0);
    spec.radius_mm = length("radius");
    spec.length_mm = length("length");
    spec.width_mm = length("width");
    spec.height_mm = length("height");
    if (has("axis")) spec.axis = direction("axis");
    if (has("along")) spec.along = direction_across(spec.axis);
    if (spec.kind == SourceKind::intensity)
      spec.table = std::make_shared<const IntensityTable>(photometry::read_intensity(file()).table);
    if (spec.kind == SourceKind::rays) spec.rays = read_rays(file(), quantity).rays;
    return spec;
  }

 private:
  static const char* name_of(LightQuantity quantity) {
    return quantity == LightQuantity::luminous ? "flux" : "power";
  }

  void refuse(const char* name, const char* why) const {
    if (has(name)) throw settings_.error(path(name), "does not belong to this source", why, "remove it");
  }

  bool is_even() const {
    if (kind() != "point") return kind() == "sphere";
    return !(settings_.number(path("exponent")).value_or(0) > 0) &&
           !(is_alone_ && settings_.has("variables.source.exponent.step"));
  }

  std::string file() const { return *settings_.text(path("file")); }

  std::pair<std::string, std::string> light_of_file() const {
    if (kind() == "rays") {
      const RayFileLight light = read_rays(file(), {});
      return {name_of(light.quantity), fmt::format("{}", light.flux)};
    }
    const IntensityTable table = photometry::read_intensity(file()).table;
    return {name_of(table.quantity()), fmt::format("{}", table.flux())};
  }

  Vector3 vector(const char* name) const {
    const Numbers v = *settings_.numbers(path(name));
    return {v[0], v[1], v[2]};
  }

  Vector3 direction(const char* name) const {
    const Vector3 found = vector(name);
    require_direction(settings_, path(name).c_str(), found);
    return found;
  }

  Vector3 direction_across(const Vector3& axis) const {
    const Vector3 along = direction("along");
    constexpr double least_sine = 1e-6;
    if (!(along.normalized().cross(axis.normalized()).norm() > least_sine))
      throw settings_.error(path("along"), "is no direction across the source's axis",
                            "it is that of its axis", "[1, 0, 0] under an axis along z");
    return along;
  }

  const Settings& settings_;
  std::string prefix_;
  bool is_alone_;
};

void complete_one(Settings& settings, const std::string& prefix) {
  const OneSource source(settings, prefix);
  source.check_keys();
  if (source.is_from_file()) settings.make_absolute(source.path("file"));
  for (const auto& [name, value] : source.defaults()) settings.fill(source.path(name), value);
  source.require_power();
}

/// What `source` itself may say when there are others: where all of them begin.
void complete_group(Settings& settings, const std::vector<std::string>& names) {
  std::vector<std::string> paths;
  for (const auto& [path, setting] : settings.all())
    if (path.starts_with("source.")) paths.push_back(path);
  for (const std::string& path : paths) {
    if (path == "source.position") continue;
    const bool kind = path == "source.kind";
    if (!(kind && (settings.where(path) == "default" || settings.text(path) == "several")))
      throw settings.error(path, "stands beside several sources",
                           "these have keys of their own, under sources." + names.front(),
                           "remove it, or sources");
  }
  settings.set({"source.kind", "\"several\"", "default"});
  settings.fill("source.position", "[0.0, 0.0, 0.0]");
  for (const std::string& name : names) {
    if (settings.text("sources." + name + ".kind") == "several")
      throw settings.error("sources." + name + ".kind", "is several", "a group holds no groups",
                           "a kind of light");
    complete_one(settings, "sources." + name);
    const std::string flux = ".flux";
    if (settings.has("sources." + name + flux) != settings.has("sources." + names.front() + flux))
      throw settings.error("sources." + name + ".power", "mixes W and lm",
                           "a scene is in W or in lm, and none is turned into the other without a spectrum",
                           "give all of them a power, or all of them a flux");
  }
}

}  // namespace

const char* power_key(LightQuantity quantity) {
  return quantity == LightQuantity::luminous ? "source.flux" : "source.power";
}

LightQuantity light_quantity(const Settings& settings) {
  const std::vector<std::string> names = settings.names_under("sources");
  const std::string first = names.empty() ? "source" : "sources." + names.front();
  return settings.has(first + ".flux") ? LightQuantity::luminous : LightQuantity::radiant;
}

void complete_source(Settings& settings) {
  const std::vector<std::string> names = settings.names_under("sources");
  if (!names.empty()) return complete_group(settings, names);
  if (settings.text("source.kind") == "several")
    throw settings.error("source.kind", "is several, and there are none", "each has its own keys",
                         "[sources.lamp] with position and power");
  complete_one(settings, "source");
}

SourceSpec source_spec(const Settings& settings, double unit_mm) {
  const std::vector<std::string> names = settings.names_under("sources");
  if (names.empty()) return OneSource(settings, "source").spec(unit_mm);
  const Numbers from = *settings.numbers("source.position");
  SourceSpec group{unit_mm * Vector3(from[0], from[1], from[2]), 0, SourceKind::several};
  for (const std::string& name : names) {
    group.parts.push_back(OneSource(settings, "sources." + name).spec(unit_mm));
    group.power_w += group.parts.back().power_w;
  }
  group.quantity = group.parts.front().quantity;
  return group;
}

void require_direction(const Settings& settings, const char* path, const Vector3& vector) {
  constexpr double least_length = 1e-100;  // the squares of shorter ones lose digits
  if (!(vector.norm() >= least_length))
    throw settings.error(path, "has no direction", "its length is zero, or nearly", "[0, 0, 1]");
}

}  // namespace catoptric::design
