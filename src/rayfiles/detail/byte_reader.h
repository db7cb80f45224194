#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/errors.h"
#include "rayfiles/detail/little_endian.h"

namespace catoptric::rayfiles::detail {

/// Reads a header field by field; what is wrong with a field is said with file, byte and name of the field.
class ByteReader {
 public:
  /// @in    end: what is wrong when a field lies beyond the bytes
  ByteReader(std::span<const std::byte> bytes, std::string name,
             std::string end = "the file ends inside its header")
      : bytes_(bytes), name_(std::move(name)), end_(std::move(end)) {}

  /// @fails InputError when the bytes end before the number
  template <typename Number>
  Number read(std::string_view field) {
    return load<Number>(take(sizeof(Number), field).data());
  }

  /// The next bytes.  @fails InputError when there are not so many
  std::span<const std::byte> take(std::uint64_t count, std::string_view field) {
    begin_ = next_;
    field_ = field;
    if (count > bytes_.size() - next_)
      refuse(end_, fmt::format("this field takes {} bytes, {} are left", count, bytes_.size() - next_),
             "copy the file again");
    next_ += count;
    return bytes_.subspan(begin_, count);
  }

  std::string text(std::uint64_t count, std::string_view field) {
    const auto bytes = take(count, field);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  /// Refuses the field that was read last.
  [[noreturn]] void refuse(std::string what, std::string why, std::string hint = "") const {
    throw InputError({std::move(what), fmt::format("{}, byte {}, {}", name_, begin_, field_), std::move(why),
                      std::move(hint)});
  }

  std::uint64_t next_byte() const { return next_; }

 private:
  std::span<const std::byte> bytes_;
  std::string name_;
  std::string end_;
  std::string field_;
  std::uint64_t begin_ = 0;
  std::uint64_t next_ = 0;
};

}  // namespace catoptric::rayfiles::detail
