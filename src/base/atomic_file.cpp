#include "base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <system_error>

#include "base/errors.h"

namespace catoptric {
namespace {

constexpr std::string_view partial_mark = ".partial";

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view what, int error) {
  throw IoError({std::string(what), path.string(), std::strerror(error),
                 "check the folder's permissions and free space"});
}

/// Takes room of that size from the disk at the file's end.  @fails IoError
void take_room(const std::filesystem::path& file, const std::filesystem::path& final_path,
               std::uint64_t bytes) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (opened < 0) fail(final_path, "cannot reopen the file", errno);
  const off_t end = ::lseek(opened, 0, SEEK_END);
  const int error = end < 0 ? errno : ::posix_fallocate(opened, end, static_cast<off_t>(bytes));
  const bool restored = end < 0 || ::ftruncate(opened, end) == 0;
  ::close(opened);
  if (error != 0)
    fail(final_path, fmt::format("there is no room for {:.3g} MB", static_cast<double>(bytes) / 1e6), error);
  if (!restored) fail(final_path, "cannot cut the file to its length", errno);
}

/// The process that a file's name says it is written by; 0 when it is no temporary of ours.
pid_t writer_of(const std::string& name) {
  const auto mark = name.rfind(partial_mark);
  const auto dot = mark == std::string::npos || mark == 0 ? mark : name.rfind('.', mark - 1);
  if (dot == std::string::npos || !name.starts_with('.')) return 0;
  pid_t writer = 0;
  const char *begin = name.data() + dot + 1, *end = name.data() + mark;
  const auto read = std::from_chars(begin, end, writer);
  return read.ec == std::errc{} && read.ptr == end ? writer : 0;
}

/// Temporaries of processes that were killed and write no more. A young one may be another machine's, whose
/// processes are not known here.
void remove_leftovers(const std::filesystem::path& folder) {
  using namespace std::chrono_literals;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const pid_t writer = writer_of(entry.path().filename().string());
    if (writer <= 0 || ::kill(writer, 0) == 0 || errno != ESRCH) continue;
    const auto age = std::filesystem::file_time_type::clock::now() - entry.last_write_time(ignored);
    if (age > 1min) std::filesystem::remove(entry.path(), ignored);
  }
}

}  // namespace

PendingFile::PendingFile(std::filesystem::path final_path) : final_(std::move(final_path)) {
  const auto name = fmt::format(".{}.{}{}{}", final_.stem().string(), ::getpid(), partial_mark,
                                final_.extension().string());
  temporary_ = final_.parent_path() / name;
  const int file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail(final_, "cannot create the file", errno);
  ::close(file);
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void PendingFile::require_room() const {
  constexpr std::uint64_t block = 65'536;  // more than any file system keeps in a half-filled block
  take_room(temporary_, final_, block);
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

void prepare_output_folder(const std::filesystem::path& folder, std::uint64_t bytes) {
  std::error_code made;
  std::filesystem::create_directories(folder, made);
  if (made) fail(folder, "cannot make the output folder", made.value());
  remove_leftovers(folder);
  const PendingFile trial(folder / "trial");
  if (bytes > 0) take_room(trial.temporary_path(), folder, bytes);
}

}  // namespace catoptric
