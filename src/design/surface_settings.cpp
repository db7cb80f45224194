#include "design/surface_settings.h"

#include <fmt/format.h>

#include "base/units.h"

namespace catoptric::design {
namespace {

constexpr const char* near_field_shares[] = {"near_field.reflectance", "near_field.specular",
                                             "near_field.roughness", "near_field.transmittance"};

/// Two keys that only say something together.
bool given_together(const Settings& settings, const char* one, const char* other, const char* why,
                    const char* hint) {
  const bool first = settings.has(one), second = settings.has(other);
  if (first != second) throw settings.error(first ? one : other, "stands alone", why, hint);
  return first;
}

void complete_mirror(Settings& settings) {
  const bool table = given_together(
      settings, "reflector.angles", "reflector.reflectances", "a table has angles and as many reflectances",
      "reflector.angles = [0, 60, 90] with reflector.reflectances = [0.9, 0.88, 1]");
  const bool metal = given_together(settings, "reflector.index", "reflector.extinction",
                                    "a metal's reflectance follows from both",
                                    "reflector.index = 1.1 with reflector.extinction = 6.6: aluminium");
  const char* twice = "the mirror's reflectance is described twice";
  if (table && metal)
    throw settings.error("reflector.index", twice, "a table of angles already gives it",
                         "remove reflector.index and reflector.extinction, or the table");
  if (!table && !metal) return settings.fill("reflector.reflectance", "1.0");
  if (settings.has("reflector.reflectance"))
    throw settings.error("reflector.reflectance", twice,
                         table ? "a table of angles already gives it"
                               : "it already follows from the metal's index and extinction",
                         table ? "remove it, or reflector.angles and reflector.reflectances"
                               : "remove it, or reflector.index and reflector.extinction");
}

void complete_near_field_surface(Settings& settings) {
  if (!*settings.boolean("near_field.real")) {
    for (const char* key : near_field_shares)
      if (settings.has(key))
        throw settings.error(key, "an invisible near field has no material", "it only registers light",
                             "near_field.real = true");
    return;
  }
  settings.fill("near_field.reflectance", "0.0");
  settings.fill("near_field.transmittance", "0.0");
}

sim::Material mirror_lobe(const Settings& settings) {
  if (const auto angles = settings.numbers("reflector.angles")) {
    std::vector<double> angles_rad = *angles;
    for (double& angle : angles_rad) angle *= pi / 180;
    try {
      return sim::Material::with_table(angles_rad, *settings.numbers("reflector.reflectances"));
    } catch (const InputError& error) {
      throw settings.error("reflector.angles", error.parts().what, error.parts().why, error.parts().hint);
    }
  }
  if (const auto index = settings.number("reflector.index"))
    return sim::Material::metal(*index, *settings.number("reflector.extinction"));
  return {*settings.number("reflector.reflectance")};
}

/// @in share, lobe: keys of the diffuse and of the mirror-like share
sim::Material checked(const Settings& settings, const std::string& table, const char* share, const char* lobe,
                      const sim::Material& material) {
  if (material.roughness != 0 && material.roughness < sim::least_roughness)
    throw settings.error(table + ".roughness", fmt::format("{} is too fine", material.roughness),
                         fmt::format("below {} a mirror is smooth", sim::least_roughness), "roughness = 0");
  if (material.reflectance + material.diffuse + material.transmittance <= 1) return material;
  std::string shares;
  const auto add = [&](const char* name, double value) {
    if (value > 0) shares += fmt::format("{}{} {}", shares.empty() ? "" : " + ", name, value);
  };
  add(material.by_angle ? "greatest reflectance" : lobe, material.reflectance);
  add(share, material.diffuse);
  add("transmittance", material.transmittance);
  const bool by_diffuse = material.diffuse > 0 && !(material.transmittance > 0);
  throw settings.error(table + (by_diffuse ? std::string(".") + share : ".transmittance"),
                       "more light leaves than arrives", fmt::format("{} is above 1", shares),
                       settings.has("reflector.index") && table == "reflector"
                           ? "a bare metal reflects all light at grazing incidence: leave the other share out"
                           : "lower one of them");
}

}  // namespace

void complete_surfaces(Settings& settings) {
  complete_mirror(settings);
  complete_near_field_surface(settings);
}

sim::Material mirror_material(const Settings& settings) {
  sim::Material material = mirror_lobe(settings);
  material.transmittance = *settings.number("reflector.transmittance");
  material.diffuse = settings.number("reflector.diffuse").value_or(0);
  material.roughness = settings.number("reflector.roughness").value_or(0);
  return checked(settings, "reflector", "diffuse", "reflectance", material);
}

std::optional<sim::Material> near_field_material(const Settings& settings) {
  if (!*settings.boolean("near_field.real")) return std::nullopt;
  sim::Material material = sim::Material::matt(*settings.number("near_field.reflectance"),
                                               *settings.number("near_field.transmittance"));
  material.reflectance = settings.number("near_field.specular").value_or(0);
  material.roughness = settings.number("near_field.roughness").value_or(0);
  return checked(settings, "near_field", "reflectance", "specular", material);
}

}  // namespace catoptric::design
