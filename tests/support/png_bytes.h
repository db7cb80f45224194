#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace catoptric::test {

/// A PNG written without libpng: the judge of what is read with it. Blocks of its deflate stream are stored.
/// @from RFC 1950, 1951, 2083
class PngBytes {
 public:
  /// @in    rows: of each the bytes behind its filter, whose kind is 0
  /// @in    colour: 0 grey, 2 colours, 3 palette, 4 grey with alpha, 6 colours with alpha
  PngBytes(std::uint32_t columns, std::uint32_t rows, int bits, int colour, int interlace = 0) {
    bytes_ = "\x89PNG\r\n\x1a\n";
    std::string head = number(columns) + number(rows);
    for (const int each : {bits, colour, 0, 0, interlace}) head += static_cast<char>(each);
    chunk("IHDR", head);
  }

  PngBytes& chunk(const std::string& name, const std::string& data) {
    bytes_ += number(static_cast<std::uint32_t>(data.size())) + name + data + number(crc(name + data));
    return *this;
  }

  /// What has been written.
  const std::string& bytes() const { return bytes_; }

  /// Ends the file with its pixels.
  std::string with_rows(const std::vector<std::string>& rows) {
    std::string raw;
    for (const std::string& row : rows) raw += std::string(1, '\0') + row;
    return with_raw(raw);
  }

  /// The same from what is to be compressed, filters and all.
  std::string with_raw(const std::string& raw) {
    std::string stream = "\x78\x01";
    for (std::size_t at = 0; at < raw.size() || at == 0; at += most_stored) {
      const std::string block = raw.substr(at, most_stored);
      const auto length = static_cast<std::uint32_t>(block.size());
      stream += static_cast<char>(at + most_stored >= raw.size() ? 1 : 0);
      for (const std::uint32_t each : {length, ~length}) {
        stream += static_cast<char>(each & 255u);
        stream += static_cast<char>((each >> 8) & 255u);
      }
      stream += block;
    }
    chunk("IDAT", stream + number(adler(raw)));
    chunk("IEND", "");
    return bytes_;
  }

 private:
  static constexpr std::size_t most_stored = 65535;

  static std::string number(std::uint32_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>((value >> shift) & 255u);
    return text;
  }

  static std::uint32_t crc(const std::string& data) {
    std::uint32_t left = 0xFFFFFFFFu;
    for (const char c : data) {
      left ^= static_cast<unsigned char>(c);
      for (int i = 0; i < 8; ++i) left = (left & 1u) != 0 ? 0xEDB88320u ^ (left >> 1) : left >> 1;
    }
    return ~left;
  }

  static std::uint32_t adler(const std::string& data) {
    std::uint32_t a = 1, b = 0;
    for (const char c : data) {
      a = (a + static_cast<unsigned char>(c)) % 65521;
      b = (b + a) % 65521;
    }
    return (b << 16) | a;
  }

  std::string bytes_;
};

/// A grey PNG of 8 bits.
inline std::string grey_png(const std::vector<std::string>& rows) {
  return PngBytes(static_cast<std::uint32_t>(rows.front().size()), static_cast<std::uint32_t>(rows.size()), 8,
                  0)
      .with_rows(rows);
}

}  // namespace catoptric::test
