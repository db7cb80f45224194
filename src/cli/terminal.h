#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

namespace catoptric::cli {

/// Whether the stream is a terminal.
bool is_terminal(std::FILE* stream);

/// Whether its text may be coloured: a terminal that is not dumb, and NO_COLOR is not set.
/// @from no-color.org
bool is_coloured(std::FILE* stream);

/// Columns of the terminal that standard error is; 80 where that is not known.
std::size_t terminal_columns();

enum class Ink { error, good, warning, strong };

/// The text as the stream may show it.
std::string inked(std::string_view text, Ink ink, std::FILE* stream);

}  // namespace catoptric::cli
