#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/errors.h"
#include "design/keys.h"

namespace catoptric::design {

using Numbers = std::vector<double>;
using Points = std::vector<Numbers>;
using Texts = std::vector<std::string>;

/// A checked value with the place it was written at.
struct Setting {
  std::variant<std::string, std::int64_t, double, bool, Numbers, Points, Texts> value;
  std::string where;  ///< "file:line" or "--set"
};

/// A `key=value` from the command line, or from a study's run.
struct Override {
  std::string path;
  std::string value;  ///< TOML text; a bare word is taken as a text
  std::string where;  ///< for messages
};

/// The keys and values of a TOML file, each checked against the table: name, type, range.
class Settings {
 public:
  /// @fails InputError for a file that cannot be read or is no TOML, an unknown key, a wrong type, a value
  /// out of range
  static Settings read(const std::filesystem::path& file, std::span<const Key> keys);
  static Settings parse(std::string_view text, const std::filesystem::path& name, std::span<const Key> keys);

  /// Replaces or adds one value.  @fails InputError as read()
  void set(const Override& change);

  /// Gives a key that is not set the value it has when left out, as text.
  void fill(const std::string& path, const std::string& value) {
    if (!has(path)) set({path, value, "default"});
  }

  /// Completes the name of a file, so that scene.toml may lie elsewhere.
  /// @in    a key that is set and names a file, in the scene's folder unless it says another
  /// @fails InputError when it is empty
  void make_absolute(const std::string& path);

  /// Takes a key away; nothing happens when it is not there.
  void remove(std::string_view path);

  bool has(std::string_view path) const { return settings_.find(path) != settings_.end(); }
  /// "file:line" of a key, or the file when the key is not there.
  std::string where(std::string_view path) const;

  std::optional<std::string> text(std::string_view path) const;
  std::optional<std::int64_t> integer(std::string_view path) const;
  std::optional<double> number(std::string_view path) const;
  std::optional<bool> boolean(std::string_view path) const;
  std::optional<Numbers> numbers(std::string_view path) const;
  std::optional<Points> points(std::string_view path) const;
  std::optional<Texts> texts(std::string_view path) const;

  /// The names X for which some key `prefix.X.Y` is set, in order; X may have dots, Y has none.
  std::vector<std::string> names_under(std::string_view prefix) const;

  /// All settings by path.
  const std::map<std::string, Setting, std::less<>>& all() const { return settings_; }

  /// Folder that relative paths start from.
  const std::filesystem::path& folder() const { return folder_; }
  /// The file as it was named.
  const std::string& file() const { return file_; }

  /// An InputError about one key.
  InputError error(std::string_view path, std::string what, std::string why, std::string hint) const;

 private:
  template <typename T>
  std::optional<T> get(std::string_view path) const;

  std::span<const Key> keys_;
  std::map<std::string, Setting, std::less<>> settings_;
  std::filesystem::path folder_;
  std::string file_;
};

}  // namespace catoptric::design
