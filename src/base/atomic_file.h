#pragma once

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

  /// @fails IoError when the file cannot be synced or renamed
  void commit();

 private:
  std::filesystem::path final_;
  std::filesystem::path temporary_;
};

/// Writes `content` to `path`, whole or not at all.
/// @fails IoError
void write_file_whole(const std::filesystem::path& path, std::string_view content);

/// Makes the folder (and its parents) and proves by a trial file that it can be written to.
/// @fails IoError
void prepare_output_folder(const std::filesystem::path& folder);

}  // namespace catoptric
