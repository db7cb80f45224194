#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace catoptric::rayfiles::detail {

static_assert(std::endian::native == std::endian::little,
              "ray files are little-endian, and read as they are");

/// The number whose bytes stand there, at any alignment.
template <typename Number>
Number load(const std::byte* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

template <typename Number>
void append(std::string& bytes, const Number& number) {
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof number);
  std::memcpy(bytes.data() + size, &number, sizeof number);
}

/// What the number would be in a file of the other byte order.
inline std::uint32_t byte_reversed(std::uint32_t number) {
  return number >> 24 | (number >> 8 & 0xff00u) | (number << 8 & 0xff0000u) | number << 24;
}

/// Text up to its first NUL.
inline std::string until_nul(std::string text) {
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

}  // namespace catoptric::rayfiles::detail
