#include "photometry/file_text.h"

#include <algorithm>

#include "base/errors.h"
#include "base/whole_file.h"

namespace catoptric::photometry {
namespace {

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

/// How many bytes the character has that begins here; 0 when none does. Of what is longer than needed only
/// the two-byte kind is looked for: no text in Latin-1 looks like the others.
std::size_t character_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if (!continues_character(text[i])) return 0;
  return length;
}

/// The longest beginning that has at most so many bytes and ends with a whole character.
std::string_view beginning(std::string_view text, std::size_t most_bytes) {
  if (text.size() <= most_bytes) return text;
  std::size_t end = most_bytes;
  while (end > 0 && continues_character(text[end])) --end;
  return text.substr(0, end > 0 ? end : most_bytes);
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string decoded(std::string_view bytes, const std::string& name, std::vector<std::string>& notes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  if (bytes.find('\0') != std::string_view::npos)
    throw InputError({"the file holds the character NUL", name, "it is text in UTF-8 or Latin-1",
                      "save it as UTF-8 if it is UTF-16"});
  if (is_utf8(bytes)) return std::string(bytes);
  notes.push_back("The file is no UTF-8; it was read as Latin-1.");
  std::string text;
  for (const char c : bytes) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      text += c;
      continue;
    }
    text += static_cast<char>(0xC0 | (code >> 6));
    text += static_cast<char>(0x80 | (code & 0x3F));
  }
  return text;
}

std::string read_photometric_text(const std::filesystem::path& file, std::vector<std::string>& notes) {
  const auto content = read_whole_file(file);
  if (const auto* defect = std::get_if<ErrorParts>(&content)) throw InputError(*defect);
  return decoded(std::get<std::string>(content), file.string(), notes);
}

std::string_view take_line(std::string_view& text) {
  const auto end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view without_blanks(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string cited(std::string_view text) {
  constexpr std::size_t most_bytes = 40;
  std::string result(beginning(text, most_bytes));
  std::replace_if(result.begin(), result.end(), is_control, '?');
  return text.size() > most_bytes ? result + "..." : result;
}

std::string one_line(std::string_view text, std::size_t most_bytes) {
  std::string result(beginning(text, most_bytes));
  std::replace_if(result.begin(), result.end(), is_control, ' ');
  return result;
}

}  // namespace catoptric::photometry
