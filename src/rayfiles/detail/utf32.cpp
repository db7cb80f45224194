#include "rayfiles/detail/utf32.h"

#include "rayfiles/detail/little_endian.h"

namespace catoptric::rayfiles::detail {
namespace {

constexpr std::uint32_t replacement = 0xFFFD;

bool is_character(std::uint32_t code) { return code < 0xD800 || (code > 0xDFFF && code <= 0x10FFFF); }

void append_utf8(std::string& text, std::uint32_t code) {
  const auto trail = [&](int shift) { text += static_cast<char>(0x80 | (code >> shift & 0x3F)); };
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xC0 | code >> 6);
    trail(0);
  } else if (code < 0x10000) {
    text += static_cast<char>(0xE0 | code >> 12);
    trail(6);
    trail(0);
  } else {
    text += static_cast<char>(0xF0 | code >> 18);
    trail(12);
    trail(6);
    trail(0);
  }
}

/// The character at the text's beginning, which is cut off; `replacement` for a byte that begins none.
std::uint32_t take_character(std::string_view& text) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
  };
  const std::uint32_t lead = byte(0);
  const std::size_t length = lead < 0x80         ? 1
                             : lead >> 5 == 0x6  ? 2
                             : lead >> 4 == 0xE  ? 3
                             : lead >> 3 == 0x1E ? 4
                                                 : 0;
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  std::uint32_t code = length == 1 ? lead : lead & (0x7Fu >> length);
  bool sound = length > 0 && length <= text.size();
  for (std::size_t i = 1; sound && i < length; ++i) {
    sound = byte(i) >> 6 == 0x2;
    code = code << 6 | (byte(i) & 0x3F);
  }
  sound = sound && code >= least[length] && is_character(code);
  text.remove_prefix(sound ? length : 1);
  return sound ? code : replacement;
}

}  // namespace

std::string utf8_of_utf32(std::span<const std::byte> bytes) {
  std::string text;
  for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4) {
    const auto code = load<std::uint32_t>(bytes.data() + i);
    if (code == 0) break;
    append_utf8(text, is_character(code) ? code : replacement);
  }
  return text;
}

std::string utf32_of_utf8(std::string_view text) {
  std::string bytes;
  while (!text.empty()) append(bytes, take_character(text));
  return bytes;
}

}  // namespace catoptric::rayfiles::detail
