#include "base/atomic_file.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <fstream>

#include "base/errors.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using catoptric::test::read_whole;
using catoptric::test::TemporaryFolder;
using catoptric::test::write_whole;

namespace {

/// No file may grow beyond this while the object lives: a disk that is full, to a writer.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limited);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

/// The number of a process that has ended.
pid_t ended_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

}  // namespace

TEST_CASE("a file appears whole, or the old one stays and nothing is left beside it") {
  const TemporaryFolder folder;
  write_file_whole(folder / "a.txt", "first");
  CHECK(read_whole(folder / "a.txt") == "first");
  {
    PendingFile pending(folder / "a.txt");
    write_whole(pending.temporary_path(), "half of the sec");
    CHECK(read_whole(folder / "a.txt") == "first");
  }
  CHECK(read_whole(folder / "a.txt") == "first");
  {
    const FileSizeLimit limit(1000);
    CHECK_THROWS_AS(write_file_whole(folder / "a.txt", std::string(5000, 'x')), IoError);
  }
  CHECK(read_whole(folder / "a.txt") == "first");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("a folder without room for the results is refused, and one with room is left as it was") {
  const TemporaryFolder folder;
  prepare_output_folder(folder / "deep" / "enough", 100'000);
  CHECK(std::filesystem::is_empty(folder / "deep" / "enough"));
  const FileSizeLimit limit(50'000);
  prepare_output_folder(folder / "small", 40'000);
  CHECK_THROWS_WITH(prepare_output_folder(folder / "full", 100'000), Catch::Contains("no room for 0.1 MB"));
  CHECK(std::filesystem::is_empty(folder / "full"));
}

TEST_CASE("a writer that does not tell of a full disk is found out") {
  const TemporaryFolder folder;
  PendingFile pending(folder / "a.step");
  const FileSizeLimit limit(100'000);
  std::ofstream out(pending.temporary_path(), std::ios::binary);
  out << std::string(20'000, 'x') << std::flush;
  CHECK_NOTHROW(pending.require_room());
  CHECK(std::filesystem::file_size(pending.temporary_path()) == 20'000);
  out << std::string(200'000, 'x') << std::flush;  // OCCT would not look whether this failed
  CHECK_THROWS_AS(pending.require_room(), IoError);
}

TEST_CASE("what killed processes left is taken away, what others write or own is not") {
  using namespace std::chrono_literals;
  const TemporaryFolder folder;
  const std::string dead = std::to_string(ended_process()), alive = std::to_string(::getpid());
  const auto old = std::filesystem::file_time_type::clock::now() - 2min;
  for (const std::string& name :
       {".a." + dead + ".partial.step", ".b." + alive + ".partial.step", std::string(".c.partial.step"),
        "d." + dead + ".partial.step", std::string("reflector.step"), std::string(".partial")}) {
    write_whole(folder / name, "x");
    std::filesystem::last_write_time(folder / name, old);
  }
  write_whole(folder / (".young." + dead + ".partial.step"), "x");
  prepare_output_folder(folder.path(), 0);
  CHECK_FALSE(std::filesystem::exists(folder / (".a." + dead + ".partial.step")));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 6);
}
