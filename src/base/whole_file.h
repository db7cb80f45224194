#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>

#include "base/errors.h"

namespace catoptric {

/// The content of a file that a user named, or what is wrong with it, in words without the place. Only
/// ordinary files are read: a pipe or a device may have no end.
/// @in    most_bytes: a larger file is refused, not begun
std::variant<std::string, ErrorParts> read_whole_file(const std::filesystem::path& file,
                                                      std::uintmax_t most_bytes = std::uintmax_t{256} << 20);

}  // namespace catoptric
