#pragma once

// Private to src/design: the only header that shows toml++.
#include <toml++/toml.h>

#include <filesystem>
#include <string>

#include "design/settings.h"

namespace catoptric::design {

/// Parses TOML text.  @fails InputError with file, line and column
toml::table parse_toml(std::string_view text, const std::string& name);

/// Reads a whole text file.  @fails InputError when it cannot be read
std::string read_text(const std::filesystem::path& file);

/// A text as TOML writes it, between quotes.
std::string quoted(const std::string& text);

/// A text short enough for a message.
std::string shortened(std::string_view text);

/// Checks a TOML value against its key and converts it.  @fails InputError with place, key, rule and remedy
Setting checked(const Key& key, std::string_view path, const toml::node& node, const std::string& where);

}  // namespace catoptric::design
