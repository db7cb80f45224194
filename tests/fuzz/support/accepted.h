#pragma once

#include <unistd.h>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "base/errors.h"

namespace catoptric::fuzz {

/// What no input may do. The fuzzer takes an exception that nobody catches for a crash, and keeps the input.
[[noreturn]] inline void finding(const std::string& what) { throw std::logic_error("FINDING: " + what); }

/// Runs a reader. What it refuses must be said in words: what, and where or why; any other exception passes
/// on and is a finding.
/// @out   whether the input was accepted
template <typename Read>
bool accepted(Read&& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    if (parts.what.empty() || (parts.where.empty() && parts.why.empty()))
      finding("a message without its parts");
    if (error.exit_code() != ExitCode::scene_invalid && error.exit_code() != ExitCode::geometry_or_exchange)
      finding("the wrong exit code");
    constexpr std::size_t readable = 20000;
    if (std::string(error.what()).size() > readable) finding("a message without end");
    return false;
  }
}

/// A file in memory whose text is the input's.
class InputFile {
 public:
  InputFile() : path_("/dev/shm/catoptric_fuzz_" + std::to_string(::getpid())) {}
  ~InputFile() { std::remove(path_.c_str()); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  const std::string& with(const void* data, std::size_t size) const {
    std::FILE* const file = std::fopen(path_.c_str(), "wb");
    if (!file || std::fwrite(data, 1, size, file) != size) std::exit(1);
    std::fclose(file);
    return path_;
  }

 private:
  std::string path_;
};

}  // namespace catoptric::fuzz
