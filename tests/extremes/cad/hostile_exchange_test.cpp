#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <thread>

#include "cad/detail/byte_packet.h"
#include "cad/detail/isolated.h"
#include "cad/detail/profile_packet.h"
#include "cad/profile_import.h"
#include "fuzz/targets/conic.h"
#include "fuzz/targets/layout.h"
#include "fuzz/targets/packet.h"
#include "support/cad/sample_profiles.h"
#include "support/sanitized.h"
#include "support/temporary_folder.h"

// Strangers' files, and the child process that reads them: whatever happens there is a message here.

using namespace catoptric;
using namespace std::chrono_literals;
using cad::detail::IsolationLimits;
using cad::detail::run_isolated;
using test::TemporaryFolder;

namespace {

constexpr IsolationLimits usual{5s, std::size_t{1} << 30};

std::size_t open_files() {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                                                std::filesystem::directory_iterator()));
}

/// No child is left, dead or alive.
bool is_alone() { return ::waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD; }

std::string refusal(const IsolationLimits& limits, const std::function<std::string()>& work) {
  const std::size_t files = open_files();
  std::string message = "accepted";
  try {
    run_isolated("file.step", limits, work);
  } catch (const CadError& error) {
    message = error.what();
    CHECK(message.find("file.step") != std::string::npos);
  }
  CHECK(open_files() == files);
  CHECK(is_alone());
  return message;
}

}  // namespace

TEST_CASE("a reading process that crashes, hangs or eats all memory is a message") {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGTERM})
    CHECK(refusal(usual, [&]() -> std::string {
            ::raise(signal);
            return "";
          }).find("signal " + std::to_string(signal)) != std::string::npos);
  const auto forever = []() -> std::string {
    for (std::atomic<long> turns{0};; turns.fetch_add(1)) {
    }
  };
  const auto begin = std::chrono::steady_clock::now();
  CHECK(refusal({200ms, usual.memory_bytes}, forever).find("within 0.2 s") != std::string::npos);
  CHECK(refusal({200ms, usual.memory_bytes}, []() -> std::string {
          std::this_thread::sleep_for(1h);
          return "";
        }).find("within 0.2 s") != std::string::npos);
  CHECK(refusal({200ms, usual.memory_bytes},
                []() -> std::string {  // deaf, with its pipe closed
                  ::close(3);
                  std::signal(SIGTERM, SIG_IGN);
                  std::this_thread::sleep_for(1h);
                  return "";
                })
            .find("within 0.2 s") != std::string::npos);
  CHECK(std::chrono::steady_clock::now() - begin < 30s);  // on a machine with other work
  if (test::address_sanitized()) return;                  // which has no memory limit
  CHECK(refusal({5s, std::size_t{100} << 20}, []() -> std::string {
          return std::string(std::size_t{200} << 20, 'x').substr(0, 1);
        }).find("not enough memory") != std::string::npos);
}

TEST_CASE("a reading process says what it will: too much, too little or nonsense is a message") {
  CHECK(refusal(usual, [] { return std::string(std::size_t{257} << 20, 'x'); }) != "accepted");
  CHECK(refusal(usual, []() -> std::string { ::_exit(0); }).find("without a result") != std::string::npos);
  CHECK(refusal(usual, []() -> std::string { ::_exit(3); }).find("without a result") != std::string::npos);
  CHECK(refusal(usual, []() -> std::string {
          static_cast<void>(!::write(3, "\x01\0\0\0\0\0\0\0r\xff\xff", 11));
          ::_exit(0);
        }).find("without a result") != std::string::npos);
  CHECK(run_isolated("file.step", usual, [] { return std::string("whole"); }) == "whole");
}

TEST_CASE("a reading process has no file of ours, leaves no core and prints nothing") {
  const TemporaryFolder folder;
  const int opened = ::open((folder / "ours").c_str(), O_RDWR | O_CREAT, 0600);
  const int ours = ::fcntl(opened, F_DUPFD, 50);  // no number that the child's pipe may have
  ::close(opened);
  REQUIRE(ours >= 50);
  const std::string seen = run_isolated("file.step", usual, [&] {
    rlimit core{};
    ::getrlimit(RLIMIT_CORE, &core);
    return std::string(::fcntl(ours, F_GETFD) == -1 ? "closed " : "open ") + std::to_string(core.rlim_cur);
  });
  ::close(ours);
  CHECK(seen == "closed 0");
  if (test::address_sanitized()) return;  // whose findings are wanted
  CHECK(run_isolated("file.step", usual, [] {
          struct stat out {
          }, nothing{};
          ::fstat(STDERR_FILENO, &out);
          ::stat("/dev/null", &nothing);
          return std::string(out.st_rdev == nothing.st_rdev ? "silent" : "loud");
        }) == "silent");
}

TEST_CASE("reading works when the program's children are reaped by the system") {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  CHECK(run_isolated("file.step", usual, [] { return std::string("whole"); }) == "whole");
  std::signal(SIGCHLD, before);
}

TEST_CASE("what is no ordinary file is refused, and nothing waits for it") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo((folder / "fifo.igs").c_str(), 0600) == 0);
  std::filesystem::create_symlink(folder / "loop.igs", folder / "loop.igs");
  for (const std::filesystem::path& file :
       {folder / "fifo.igs", std::filesystem::path("/dev/zero"), folder / "loop.igs",
        std::filesystem::path(std::string(100000, 'x'))})
    CHECK_THROWS_AS(cad::import_profile(file), CadError);
}

TEST_CASE("a packed profile is unpacked, and every cut or changed one is refused or finite") {
  const cad::ImportedProfile imported{test::wavy_profile(4, true), {"a note", ""}, {"candidate"}};
  const std::string bytes = cad::detail::pack_profile(imported);
  const cad::ImportedProfile again = cad::detail::unpack_profile(bytes, "f");
  CHECK(again.profile == imported.profile);
  CHECK(again.notes == imported.notes);
  CHECK(again.candidates == imported.candidates);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK_THROWS_AS(cad::detail::unpack_profile(bytes.substr(0, size), "f"), CadError);
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (const char put : {'\xff', '\x7f', '\0'}) {
      std::string changed = bytes;
      changed[at] = put;
      CHECK_NOTHROW(fuzz::try_packet(changed));
    }
}

TEST_CASE("inputs that once broke the exchange end as they must") {
  const std::vector<std::pair<std::string, void (*)(std::string_view)>> readers{
      {"conic", fuzz::try_conic}, {"layout", fuzz::try_layout}, {"packet", fuzz::try_packet}};
  const auto files = [](const std::string& name) {
    std::vector<std::filesystem::path> list;
    const std::filesystem::path folder = std::string(CATOPTRIC_DATA) + "/fuzz/" + name;
    if (std::filesystem::exists(folder))
      for (const auto& entry : std::filesystem::directory_iterator(folder)) list.push_back(entry.path());
    return list;
  };
  for (const auto& [name, reader] : readers)
    for (const auto& file : files(name)) {
      INFO(file.string());
      CHECK_NOTHROW(reader(test::read_whole(file)));
    }
  std::size_t count = 0;
  for (const char* format : {"iges", "step"})
    for (const auto& file : files(format)) {
      ++count;
      INFO(file.string());
      cad::ImportOptions options;
      options.time_limit = 2s;
      CHECK_THROWS_AS(cad::import_profile(file, options), CadError);
      CHECK(is_alone());
    }
  CHECK(count > 0);
}
