#include "design/designed_scene.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "design/scene_defaults.h"

namespace catoptric::design {
namespace {

constexpr const char* found_by = "design";

/// "source.z" is the third number of source.position; the others have keys of their names.
void put_variable(Settings& settings, const std::string& name, double value) {
  const auto axis = name == "source.x"   ? std::optional<std::size_t>(0)
                    : name == "source.y" ? std::optional<std::size_t>(1)
                    : name == "source.z" ? std::optional<std::size_t>(2)
                                         : std::nullopt;
  if (!axis) return settings.set({name, fmt::format("{}", value), found_by});
  Numbers place = *settings.numbers("source.position");
  place[*axis] = value;
  settings.set({"source.position", fmt::format("[{}, {}, {}]", place[0], place[1], place[2]), found_by});
}

/// A reference mirror's light is made by the scene's source: with another source it would be another target.
void remove_target(Settings& settings) {
  std::vector<std::string> paths;
  for (const auto& [path, setting] : settings.all())
    if (path.starts_with("target.")) paths.push_back(path);
  for (const std::string& path : paths) settings.remove(path);
}

}  // namespace

Scene designed_scene(const Scene& scene, const Judged& found) {
  Settings settings = scene.settings;
  for (const std::string& name : settings.names_under("variables"))
    for (const char* part : {"start", "step", "lower", "upper"})
      settings.remove(fmt::format("variables.{}.{}", name, part));
  for (const char* part : {"variables", "lower", "upper", "steps", "greatest", "paths", "starts"})
    settings.remove(fmt::format("landscape.{}", part));
  settings.remove("search.refine");
  settings.set({"search.method", "\"none\"", found_by});
  settings.set({"search.free", "\"listed\"", found_by});
  put_profile(settings, found.profile, found_by);
  bool other_source = false;
  for (std::size_t i = 0; i < found.names.size(); ++i)
    if (parse_scene_variable(found.names[i])) {
      put_variable(settings, found.names[i], found.variables[i]);
      other_source = true;
    }
  if (other_source && scene.target.kind == TargetKind::reflector) remove_target(settings);
  return make_scene(std::move(settings));
}

std::string designed_text(const Scene& scene, const Judged& found) {
  return scene_text(designed_scene(scene, found));
}

}  // namespace catoptric::design
