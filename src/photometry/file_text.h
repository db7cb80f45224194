#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::photometry {

/// Whether nothing but well-formed UTF-8 is in it.
bool is_utf8(std::string_view text);

/// The text as UTF-8, without a byte order mark; what is no UTF-8 is taken for Latin-1.
/// @in    notes: told when Latin-1 was taken
/// @fails InputError when the character NUL shows that it is no text, or UTF-16
std::string decoded(std::string_view bytes, const std::string& name, std::vector<std::string>& notes);

/// The file's text, as above.
/// @fails InputError when it cannot be read
std::string read_photometric_text(const std::filesystem::path& file, std::vector<std::string>& notes);

/// Takes the first line off the text, without its end (LF or CR LF).
std::string_view take_line(std::string_view& text);

/// Without blanks at both ends.
std::string_view without_blanks(std::string_view text);

/// For messages: at most 40 bytes of it, control characters as '?'.
std::string cited(std::string_view text);

/// One line of text for a file: control characters are blanks, at most so many bytes, no character cut.
std::string one_line(std::string_view text, std::size_t most_bytes);

}  // namespace catoptric::photometry
