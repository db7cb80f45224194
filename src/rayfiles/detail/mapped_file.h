#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace catoptric::rayfiles::detail {

/// An ordinary file in the address space, read-only: the system reads a page when it is looked at and may
/// drop it again, so that a file may be larger than the memory.
///
/// A file that another program cuts short meanwhile ends this process by SIGBUS when a lost page is looked
/// at. There is no cheap guard; require_unchanged() before a long pass finds what was cut before it.
class MappedFile {
 public:
  /// @fails InputError when there is no such file, it is no ordinary one, empty, or cannot be mapped
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::byte> bytes() const { return bytes_; }
  const std::string& name() const { return name_; }

  /// @fails InputError when the file has another size or time of change than when it was opened
  void require_unchanged() const;

 private:
  struct State {
    long long size, seconds, nanoseconds;
    bool operator==(const State&) const = default;
  };
  State state() const;
  void map();
  [[noreturn]] void refuse(const std::string& what, const std::string& why, const std::string& hint) const;

  std::string name_;
  int file_ = -1;
  State opened_{};
  std::span<const std::byte> bytes_;
};

}  // namespace catoptric::rayfiles::detail
