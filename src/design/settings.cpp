#include "design/settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "design/toml_values.h"

namespace catoptric::design {
namespace {

/// A key of the table at `path`, or the error that names the nearest known one.
const Key& known_key(std::span<const Key> keys, const std::string& path, const std::string& where) {
  if (const Key* key = find_key(keys, path)) return *key;
  const std::string near = nearest_path(keys, path);
  throw InputError(
      {fmt::format("unknown key {}", shortened(path)), where,
       "every key must be known, so that no typing error passes",
       near.empty() ? "catoptric --keys lists them all" : fmt::format("did you mean {}?", near)});
}

using Map = std::map<std::string, Setting, std::less<>>;

void collect(const toml::table& table, const std::string& prefix, const std::string& file,
             std::span<const Key> keys, Map& settings) {
  for (const auto& [name, node] : table) {
    const std::string path =
        prefix.empty() ? std::string(name.str()) : prefix + "." + std::string(name.str());
    const std::string where = fmt::format("{}:{}", file, node.source().begin.line);
    if (const toml::table* inner = node.as_table(); inner && !find_key(keys, path)) {
      if (inner->empty()) continue;
      collect(*inner, path, file, keys, settings);
      continue;
    }
    const Key& key = known_key(keys, path, where);
    settings.insert_or_assign(path, checked(key, path, node, where));
  }
}

}  // namespace

Settings Settings::read(const std::filesystem::path& file, std::span<const Key> keys) {
  return parse(read_text(file), file, keys);
}

Settings Settings::parse(std::string_view text, const std::filesystem::path& name,
                         std::span<const Key> keys) {
  Settings settings;
  settings.keys_ = keys;
  settings.file_ = name.string();
  settings.folder_ = name.parent_path();
  collect(parse_toml(text, settings.file_), "", settings.file_, keys, settings.settings_);
  return settings;
}

void Settings::set(const Override& change) {
  const Key& key = known_key(keys_, change.path, change.where);
  toml::table table;
  try {
    table = parse_toml("value = " + change.value, change.where);
  } catch (const InputError&) {  // a bare word: the shell took the quotes away
    try {
      table = toml::parse("value = " + quoted(change.value));
    } catch (const toml::parse_error&) {
      throw InputError({fmt::format("the value of {} is no text", change.path), change.where,
                        "it is not in UTF-8", "key=value"});
    }
  }
  if (table.size() != 1)
    throw InputError(
        {fmt::format("{} is given more than one value", change.path), change.where, "", "key=value"});
  settings_.insert_or_assign(change.path, checked(key, change.path, *table.get("value"), change.where));
}

void Settings::make_absolute(const std::string& path) {
  if (text(path)->empty()) throw error(path, "is empty", "it names a file", "leave it out, or name one");
  const auto absolute = std::filesystem::absolute(folder() / *text(path)).lexically_normal();
  set({path, quoted(absolute.string()), where(path)});
}

void Settings::remove(std::string_view path) {
  if (const auto found = settings_.find(path); found != settings_.end()) settings_.erase(found);
}

std::string Settings::where(std::string_view path) const {
  const auto found = settings_.find(path);
  return found == settings_.end() ? file_ : found->second.where;
}

template <typename T>
std::optional<T> Settings::get(std::string_view path) const {
  const auto found = settings_.find(path);
  if (found == settings_.end()) return std::nullopt;
  return std::get<T>(found->second.value);
}

std::optional<std::string> Settings::text(std::string_view path) const { return get<std::string>(path); }
std::optional<std::int64_t> Settings::integer(std::string_view path) const { return get<std::int64_t>(path); }
std::optional<double> Settings::number(std::string_view path) const { return get<double>(path); }
std::optional<bool> Settings::boolean(std::string_view path) const { return get<bool>(path); }
std::optional<Numbers> Settings::numbers(std::string_view path) const { return get<Numbers>(path); }
std::optional<Points> Settings::points(std::string_view path) const { return get<Points>(path); }
std::optional<Texts> Settings::texts(std::string_view path) const { return get<Texts>(path); }

std::vector<std::string> Settings::names_under(std::string_view prefix) const {
  std::vector<std::string> names;
  const std::string start = std::string(prefix) + ".";
  for (const auto& [path, setting] : settings_) {
    if (!path.starts_with(start)) continue;
    std::string name = path.substr(start.size());
    name = name.substr(0, name.rfind('.'));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

InputError Settings::error(std::string_view path, std::string what, std::string why, std::string hint) const {
  return InputError({fmt::format("{}: {}", path, what), where(path), std::move(why), std::move(hint)});
}

}  // namespace catoptric::design
