#pragma once

#include <filesystem>
#include <string>

namespace catoptric {

/// A folder of a process's own where temporary files go (TMPDIR), gone with it.
class ScratchFolder {
 public:
  /// @fails IoError where none can be made
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// All files in a folder and below it as bytes, so that one process can make what another one writes.
/// @fails IoError for a file that cannot be read
std::string folder_bytes(const std::filesystem::path& folder);

/// Writes the files into another folder, each whole or not at all.
/// @in    what folder_bytes() gave
/// @fails IoError
void write_folder(const std::string& bytes, const std::filesystem::path& folder);

}  // namespace catoptric
