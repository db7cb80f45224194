#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace catoptric {

/// A file that appears whole or not at all: written under a temporary name beside its final one, synced and
/// renamed by commit(), removed by the destructor otherwise.
class PendingFile {
 public:
  /// @fails IoError when the folder does not exist or is not writable
  explicit PendingFile(std::filesystem::path final_path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write before commit(). Its extension is the final one's, which some writers look at.
  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// For writers that do not tell: whether the disk ran full under the temporary file. To be asked when it is
  /// written.
  /// @fails IoError when the file cannot grow any more
  void require_room() const;

  /// @fails IoError when the file cannot be synced or renamed
  void commit();

 private:
  std::filesystem::path final_;
  std::filesystem::path temporary_;
};

/// Writes `content` to `path`, whole or not at all.
/// @fails IoError
void write_file_whole(const std::filesystem::path& path, std::string_view content);

/// Makes the folder (and its parents) and proves by a trial file, taken away again, that so many bytes can be
/// written there. What a quota or a limit on file sizes forbids is found too. Temporary files that killed
/// processes left there more than a minute ago are taken away.
/// @fails IoError
void prepare_output_folder(const std::filesystem::path& folder, std::uint64_t bytes);

}  // namespace catoptric
