#include "base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "base/errors.h"

namespace catoptric {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view what, int error) {
  throw IoError({std::string(what), path.string(), std::strerror(error),
                 "check the folder's permissions and free space"});
}

}  // namespace

PendingFile::PendingFile(std::filesystem::path final_path) : final_(std::move(final_path)) {
  const auto name =
      fmt::format(".{}.{}.partial{}", final_.stem().string(), ::getpid(), final_.extension().string());
  temporary_ = final_.parent_path() / name;
  const int file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail(final_, "cannot create the file", errno);
  ::close(file);
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void PendingFile::commit() {
  const int file = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail(final_, "cannot reopen the file", errno);
  const int synced = ::fsync(file);
  const int error = errno;
  ::close(file);
  if (synced != 0) fail(final_, "cannot flush the file to disk", error);
  std::error_code renamed;
  std::filesystem::rename(temporary_, final_, renamed);
  if (renamed) fail(final_, "cannot rename the finished file", renamed.value());
  temporary_.clear();
}

void write_file_whole(const std::filesystem::path& path, std::string_view content) {
  PendingFile pending(path);
  std::ofstream out(pending.temporary_path(), std::ios::binary | std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.flush();
  if (!out) fail(path, "cannot write the file", errno ? errno : EIO);
  out.close();
  pending.commit();
}

void prepare_output_folder(const std::filesystem::path& folder) {
  std::error_code made;
  std::filesystem::create_directories(folder, made);
  if (made) fail(folder, "cannot make the output folder", made.value());
  PendingFile trial(folder / "trial");
}

}  // namespace catoptric
