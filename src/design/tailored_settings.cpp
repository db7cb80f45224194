#include "design/tailored_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "design/scene_defaults.h"
#include "design/tailored_start.h"
#include "design/variables.h"

namespace catoptric::design {
namespace {

constexpr const char* made_by = "start = \"tailored\"";

void put(Settings& settings, const std::string& path, double value) {
  settings.set({path, fmt::format("{}", value), made_by});
}

}  // namespace

Settings tailored_settings(const Scene& scene, bool from_nothing, std::vector<std::string>& notes) {
  const TailoredStart start = from_nothing ? tailored_from_nothing(scene) : tailored_variables(scene);
  Settings settings = scene.settings;
  const bool whole = from_nothing || settings.text("search.free") == "profile";
  if (whole) put_profile(settings, start.profile, made_by);
  for (const optim::Variable& variable : scene.variables) {
    if (from_nothing || parse_scene_variable(variable.name)) continue;
    const auto component = parse_component(variable.name, start.profile.points().size());
    // A value on its bound must not leave it by a rounding.
    put(settings, "variables." + variable.name + ".start",
        std::clamp(component_value(start.profile, *component, scene.unit), variable.lower, variable.upper));
  }
  if (start.level != 1)
    put(settings, "target.level", start.level * settings.number("target.level").value_or(1));
  if (scene.target.free_scale) settings.set({"target.scale", "\"absolute\"", made_by});
  settings.set({"start", "\"profile\"", made_by});
  settings.remove("tailored.vertex");
  // A mirror made from nothing is done unless more is asked for.
  if (from_nothing && scene.variables.empty() && settings.text("search.free") == "listed")
    settings.set({"search.method", "\"none\"", made_by});
  notes.insert(notes.end(), start.notes.begin(), start.notes.end());
  return settings;
}

}  // namespace catoptric::design
