#include "images/netpbm_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/errors.h"
#include "images/grey_image.h"

namespace catoptric::images {
namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// Of a word that may be a whole file.
std::string shown(std::string_view word) {
  constexpr std::size_t most = 20;
  std::string text;
  for (const char c : word.substr(0, most)) text += c >= ' ' && c <= '~' ? c : '?';
  return word.size() > most ? text + "..." : text;
}

}  // namespace

std::string_view NetpbmWords::next() {
  while (!left_.empty() && (is_blank(left_.front()) || left_.front() == '#')) {
    if (left_.front() == '#')
      left_.remove_prefix(std::min(left_.find('\n'), left_.size()));
    else
      left_.remove_prefix(1);
  }
  std::size_t length = 0;
  while (length < left_.size() && !is_blank(left_[length]) && left_[length] != '#') ++length;
  const std::string_view word = left_.substr(0, length);
  left_.remove_prefix(length);
  return word;
}

std::size_t NetpbmWords::integer(std::string_view what, std::size_t least, std::size_t greatest) {
  const std::string_view word = next();
  if (word.empty())
    throw InputError({fmt::format("it ends before its {}", what), name_, "the file is cut off", ""});
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc{} && end == word.data() + word.size();
  if (!whole || value < least || value > greatest)
    throw InputError({fmt::format("its {} is \"{}\"", what, shown(word)), name_,
                      fmt::format("a whole number from {} to {} stands there", least, greatest), ""});
  return value;
}

void NetpbmWords::end_header() {
  if (left_.empty() || !is_blank(left_.front()))
    throw InputError({"no blank stands behind its header", name_, "one divides header and pixels", ""});
  left_.remove_prefix(1);
}

void require_few_pixels(std::size_t columns, std::size_t rows, const std::string& name) {
  if (columns <= longest_side && rows <= longest_side && columns * rows <= most_pixels) return;
  throw InputError(
      {fmt::format("{} columns by {} rows are too many", columns, rows), name,
       fmt::format("at most {} pixels are taken, and {} in a row or column", most_pixels, longest_side),
       "make it smaller: a near field has a million samples at most"});
}

void require_bytes(std::size_t found, std::size_t expected, const std::string& name) {
  if (found == expected) return;
  throw InputError({fmt::format("{} bytes of pixels, where {} belong", found, expected), name,
                    "columns times rows times the bytes of a pixel",
                    found < expected ? "the file may be cut off" : "a file holds one picture"});
}

std::string place_of(std::size_t row, std::size_t column) {
  return fmt::format("row {}, column {}", row + 1, column + 1);
}

}  // namespace catoptric::images
