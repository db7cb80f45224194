#include <fmt/format.h>

#include <algorithm>

#include "design/scene.h"
#include "design/search.h"
#include "design/toml_values.h"

namespace catoptric::design {
namespace {

/// Shortest text that reads back as the same double, and as a TOML float.
std::string number(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

/// A name as a key of TOML: bare where that is allowed.
std::string key(const std::string& name) {
  const bool bare = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare && !name.empty() ? name : quoted(name);
}

struct ValueText {
  std::string operator()(const std::string& value) const { return quoted(value); }
  std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
  std::string operator()(double value) const { return number(value); }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  template <typename T>
  std::string operator()(const std::vector<T>& values) const {
    std::string text = "[";
    for (const T& value : values) text += (text.size() > 1 ? ", " : "") + (*this)(value);
    return text + "]";
  }
};

}  // namespace

std::string scene_text(const Scene& scene) {
  std::string text =
      "# Every key with the value it had; running this file again gives the same result, bit for bit.\n";
  std::string open_table;
  const auto write = [&](const std::string& path, const Setting& setting) {
    const auto dot = path.rfind('.');
    const std::string table = dot == std::string::npos ? "" : path.substr(0, dot);
    if (table != open_table) {
      const auto dot_before = table.find('.');
      text += dot_before == std::string::npos ? fmt::format("\n[{}]\n", table)
                                              : fmt::format("\n[{}.{}]\n", table.substr(0, dot_before),
                                                            key(table.substr(dot_before + 1)));
      open_table = table;
    }
    text += fmt::format("{} = {}\n", path.substr(dot == std::string::npos ? 0 : dot + 1),
                        std::visit(ValueText{}, setting.value));
  };
  const auto write_set = [&](std::string_view path) {
    if (const auto found = scene.settings.all().find(path); found != scene.settings.all().end())
      write(found->first, found->second);
  };
  for (const Key& key : scene_keys())
    if (key.path.find('*') == std::string_view::npos) write_set(key.path);
  for (const std::string several : {"sources", "fields", "objects"})
    for (const std::string& name : scene.settings.names_under(several))
      for (const Key& key : scene_keys())
        if (key.path.starts_with(several + ".*."))
          write_set(fmt::format("{}.{}.{}", several, name, key.path.substr(several.size() + 3)));
  std::vector<std::string> listed = scene.settings.names_under("variables");  // all that free ones start from
  if (scene.search.free == Freedom::listed) listed = names(scene.variables);
  for (const std::string& name : listed)
    for (const char* part : {"start", "step", "lower", "upper"}) {
      const std::string path = fmt::format("variables.{}.{}", name, part);
      write(path, scene.settings.all().find(path)->second);
    }
  return text;
}

}  // namespace catoptric::design
