#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace catoptric::cad::detail {

/// Texts and numbers as bytes, for the same program on the same machine.
class BytePacket {
 public:
  void put(double value) { append(&value, sizeof value); }
  void put(std::size_t value) { append(&value, sizeof value); }
  void put(std::string_view text) {
    put(text.size());
    bytes_.append(text);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string bytes_;
};

/// Reads a packet in the order it was put; past its end everything is empty or 0 and is_whole() false.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}
  double number() { return take<double>(); }
  std::size_t count() { return take<std::size_t>(); }
  /// How many items of at least so many bytes follow; 0 and not whole when they cannot all be there.
  std::size_t count_of(std::size_t least_size) {
    const std::size_t count = this->count();
    if (count <= rest_.size() / least_size) return count;
    whole_ = false;
    return 0;
  }
  std::string text() {
    const std::size_t size = count();
    if (size > rest_.size()) {
      whole_ = false;
      return {};
    }
    std::string result(rest_.substr(0, size));
    rest_.remove_prefix(size);
    return result;
  }
  bool is_whole() const { return whole_; }

 private:
  template <typename Value>
  Value take() {
    Value value{};
    if (rest_.size() < sizeof value) {
      whole_ = false;
      return value;
    }
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }

  std::string_view rest_;
  bool whole_ = true;
};

}  // namespace catoptric::cad::detail
