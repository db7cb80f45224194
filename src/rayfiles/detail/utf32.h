#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace catoptric::rayfiles::detail {

/// UTF-8 of little-endian UTF-32 up to the first NUL; what is no character becomes U+FFFD.
/// @in    a multiple of 4 bytes
std::string utf8_of_utf32(std::span<const std::byte> bytes);

/// Little-endian UTF-32 of UTF-8, without a NUL at its end; bytes that are no UTF-8 become U+FFFD one by one.
std::string utf32_of_utf8(std::string_view text);

}  // namespace catoptric::rayfiles::detail
