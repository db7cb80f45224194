#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace catoptric::report {

/// Text from a user made fit for one line of a table, a plot or a page: valid UTF-8 (a broken byte becomes
/// U+FFFD), control characters (line ends included) become blanks.
std::string clean_line(std::string_view text);

/// Columns that valid UTF-8 text takes on a terminal, one per code point.
std::size_t width_of(std::string_view text);

}  // namespace catoptric::report
