#include "rayfiles/detail/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/errors.h"

namespace catoptric::rayfiles::detail {

MappedFile::MappedFile(const std::filesystem::path& file) : name_(file.string()) {
  if (const auto nul = name_.find('\0'); nul != std::string::npos) {
    name_.resize(nul);
    refuse("this is no name of a file", "it holds the character NUL", "check the name");
  }
  file_ = ::open(name_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe must not make us wait
  if (file_ < 0) refuse("the file cannot be opened", std::strerror(errno), "check the path");
  try {
    map();
  } catch (...) {
    ::close(file_);
    throw;
  }
}

MappedFile::~MappedFile() {
  ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
  ::close(file_);
}

void MappedFile::map() {
  struct stat status {};
  if (::fstat(file_, &status) != 0) refuse("the file cannot be read", std::strerror(errno), "check the path");
  if (!S_ISREG(status.st_mode))
    refuse("this is not a file", "it is a folder, a pipe or a device", "name an ordinary file");
  opened_ = state();
  if (opened_.size == 0) refuse("the file is empty", "a header and rays are needed", "copy the file again");
  const auto size = static_cast<std::size_t>(opened_.size);
  void* const begin = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file_, 0);
  if (begin == MAP_FAILED)
    refuse("the file cannot be mapped", std::strerror(errno), "raise the limit of address space (ulimit -v)");
  bytes_ = {static_cast<const std::byte*>(begin), size};
}

MappedFile::State MappedFile::state() const {
  struct stat status {};
  if (::fstat(file_, &status) != 0) refuse("the file cannot be read", std::strerror(errno), "check the disk");
  return {status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

void MappedFile::require_unchanged() const {
  const State now = state();
  if (now.size != opened_.size)
    refuse("the file has changed while it is in use",
           "it had " + std::to_string(opened_.size) + " bytes and has " + std::to_string(now.size),
           "run again when nobody writes to it");
  if (now != opened_)
    refuse("the file has changed while it is in use", "it was written to",
           "run again when nobody writes to it");
}

void MappedFile::refuse(const std::string& what, const std::string& why, const std::string& hint) const {
  throw InputError({what, name_, why, hint});
}

}  // namespace catoptric::rayfiles::detail
