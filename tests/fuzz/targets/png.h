#pragma once

#include <string>
#include <vector>

#include "fuzz/targets/picture_check.h"
#include "support/png_bytes.h"

namespace catoptric::fuzz {

/// PNG files. The first byte says how the rest is taken: as the file itself, which checksums keep from
/// changing much; as chunks, each a name, a length of one byte and data, which get right checksums; or as the
/// pixels of a picture behind five bytes of columns, rows, bits, colour and interlace.
inline void try_png(std::string_view input) {
  if (input.empty()) return;
  const int way = static_cast<unsigned char>(input[0]) % 3;
  input.remove_prefix(1);
  if (way == 0) return try_picture(input);
  const auto byte = [&](std::size_t i) -> unsigned { return static_cast<unsigned char>(input[i]); };
  constexpr std::size_t head = 5;
  if (input.size() < head) return;
  test::PngBytes png(byte(0), byte(1), static_cast<int>(byte(2)), static_cast<int>(byte(3)),
                     static_cast<int>(byte(4)));
  input.remove_prefix(head);
  if (way == 1) {
    constexpr std::size_t name = 4;
    while (input.size() > name) {
      const std::size_t length = std::min<std::size_t>(byte(name), input.size() - name - 1);
      png.chunk(std::string(input.substr(0, name)), std::string(input.substr(name + 1, length)));
      input.remove_prefix(name + 1 + length);
    }
    return try_picture(png.chunk("IEND", "").bytes());
  }
  // All bytes as one row: its length need not be that of rows, and the filter's kind is the first byte.
  try_picture(png.with_raw(std::string(input)));
}

}  // namespace catoptric::fuzz
