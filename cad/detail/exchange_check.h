#pragma once

#include <filesystem>
#include <optional>

namespace catoptric::cad::detail {

enum class ExchangeKind { iges, step };

/// Tells the format by the file's first lines, whatever its name.
/// @fails CadError when there is no such file, it cannot be read, or it is neither
ExchangeKind kind_of_file(const std::filesystem::path& file);

/// Refuses files that are cut off or not laid out as their standard says, before OCCT, which trusts them.
/// @fails CadError
void check_iges_layout(const std::filesystem::path& file);
void check_step_layout(const std::filesystem::path& file);

}  // namespace catoptric::cad::detail
