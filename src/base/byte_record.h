#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace catoptric {

/// Values in a row as bytes, to be read in the same order by the same program on the same kind of machine:
/// plain values, strings, and lists of these.
class ByteWriter {
 public:
  template <class Value>
  requires std::is_trivially_copyable_v<Value> ByteWriter& put(const Value& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  ByteWriter& put(const std::string& text) {
    put(static_cast<std::uint64_t>(text.size()));
    bytes_ += text;
    return *this;
  }
  template <class Value>
  ByteWriter& put(const std::vector<Value>& list) {
    put(static_cast<std::uint64_t>(list.size()));
    if constexpr (std::is_trivially_copyable_v<Value>)
      bytes_.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(Value));
    else
      for (const Value& each : list) put(each);
    return *this;
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what a ByteWriter wrote.
class ByteReader {
 public:
  /// @in bytes outlives this
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}

  /// @fails std::runtime_error where the bytes end before the value does: our mistake
  template <class Value>
  requires std::is_trivially_copyable_v<Value> ByteReader& get(Value& value) {
    std::memcpy(&value, next(sizeof value), sizeof value);
    return *this;
  }
  ByteReader& get(std::string& text) {
    const auto size = get<std::uint64_t>();
    text.assign(next(size), size);
    return *this;
  }
  template <class Value>
  ByteReader& get(std::vector<Value>& list) {
    list.clear();
    const auto size = get<std::uint64_t>();
    if constexpr (std::is_trivially_copyable_v<Value>) {
      if (size > (bytes_.size() - at_) / sizeof(Value)) next(bytes_.size() + 1);  // refuses
      list.resize(size);
      if (size > 0) std::memcpy(list.data(), next(size * sizeof(Value)), size * sizeof(Value));
    } else {
      for (auto left = size; left > 0; --left) list.push_back(get<Value>());
    }
    return *this;
  }
  template <class Value>
  Value get() {
    Value value{};
    get(value);
    return value;
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  const char* next(std::size_t size) {
    if (size > bytes_.size() - at_)
      throw std::runtime_error("a message between ranks ends before its last value");
    const char* place = bytes_.data() + at_;
    at_ += size;
    return place;
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace catoptric
