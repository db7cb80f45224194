#include "cad/detail/isolated.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <thread>

#include "base/errors.h"
#include "base/sanitized.h"
#include "cad/detail/byte_packet.h"
#include "cad/detail/occt_guard.h"

namespace catoptric::cad::detail {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t most_bytes = std::size_t{256} << 20;  // a result has some kB

enum class Outcome : char { result = 'r', cad_error = 'c', other_error = 'o' };

std::string failure_packet(Outcome outcome, const ErrorParts& parts) {
  BytePacket packet;
  packet.put(std::string(1, static_cast<char>(outcome)));
  for (const std::string& part : {parts.what, parts.where, parts.why, parts.hint}) packet.put(part);
  return packet.bytes();
}

std::string packet_of(const std::string& where, const std::function<std::string()>& work) {
  try {
    BytePacket packet;
    const std::string result = work();
    packet.put(std::string(1, static_cast<char>(Outcome::result)));
    packet.put(result);
    return packet.bytes();
  } catch (const CadError& error) {
    return failure_packet(Outcome::cad_error, error.parts());
  } catch (const std::bad_alloc&) {
    return failure_packet(Outcome::cad_error, {"the file cannot be read", where,
                                               "there is not enough memory for it", "export less"});
  } catch (const std::exception& error) {
    return failure_packet(Outcome::other_error, {error.what(), "", "", ""});
  }
}

/// Bytes of address space that this process has.
std::size_t address_space() {
  std::ifstream in("/proc/self/statm");
  std::size_t pages = 0;
  in >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void set_limit(int resource, rlim_t value) {
  const rlimit limit{value, value};
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &limit);
}

/// Leaves the child nothing open but its pipe, whose number is handed back: broken memory must not reach the
/// parent's files, and what the C library says of it must not reach the terminal.
int keep_only(int pipe) {
  constexpr int kept = STDERR_FILENO + 1;
  if (pipe != kept) ::dup2(pipe, kept);
  ::close_range(kept + 1, ~0U, 0);
#ifndef CATOPTRIC_ADDRESS_SANITIZED  // whose findings are wanted
  if (const int nothing = ::open("/dev/null", O_RDWR); nothing >= 0)
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
#endif
  return kept;
}

/// The child's whole life. It ends without exit handlers, which belong to the parent.
[[noreturn]] void live_as_child(pid_t parent, int pipe, const std::string& where,
                                const IsolationLimits& limits, const std::function<std::string()>& work) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGINT, SIGTERM, SIGPIPE})
    std::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // or it works on when the parent is killed
  if (::getppid() != parent) ::_exit(1);
  set_limit(RLIMIT_CPU, static_cast<rlim_t>(std::chrono::ceil<std::chrono::seconds>(limits.time).count()));
  set_limit(RLIMIT_CORE, 0);
#ifndef CATOPTRIC_ADDRESS_SANITIZED  // which reserves terabytes
  set_limit(RLIMIT_AS, address_space() + limits.memory_bytes);
#endif
  pipe = keep_only(pipe);
  ExchangeSession::enter_child_process();
  const std::string bytes = packet_of(where, work);
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t now = ::write(pipe, bytes.data() + sent, bytes.size() - sent);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) ::_exit(1);
    sent += static_cast<std::size_t>(now);
  }
  ::_exit(0);
}

/// Everything the child sends until it closes the pipe, or nothing when the time is over or it is too much.
std::optional<std::string> receive(int pipe, Clock::time_point deadline) {
  std::string bytes;
  std::array<char, 65536> buffer{};
  while (bytes.size() <= most_bytes) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return std::nullopt;
    pollfd ready{pipe, POLLIN, 0};
    const int count = ::poll(&ready, 1, static_cast<int>(left));
    if (count < 0 && errno != EINTR) return bytes;
    if (count <= 0) continue;
    const ssize_t got = ::read(pipe, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return bytes;
    bytes.append(buffer.data(), static_cast<std::size_t>(got));
  }
  return std::nullopt;
}

/// How the child ended; one that has closed its pipe and lives on is killed when the time is over.
int wait_for(pid_t child, Clock::time_point deadline) {
  using std::chrono::microseconds;
  constexpr microseconds longest_nap{10000};
  int status = 0;
  for (microseconds nap{20};; nap = std::min(2 * nap, longest_nap)) {
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child || (ended < 0 && errno != EINTR)) return status;
    if (Clock::now() >= deadline) break;
    std::this_thread::sleep_for(nap);
  }
  ::kill(child, SIGKILL);
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

[[noreturn]] void refuse(std::string_view where, std::string why) {
  throw CadError({"the file cannot be read", std::string(where), std::move(why),
                  "export it again; if it is as the CAD program wrote it, try the other of IGES and STEP"});
}

std::string unpack(std::string_view where, const std::string& bytes) {
  ByteReader reader(bytes);
  const std::string outcome = reader.text();
  if (!outcome.empty() && outcome[0] == static_cast<char>(Outcome::result)) {
    std::string result = reader.text();
    if (reader.is_whole()) return result;
  }
  ErrorParts parts{reader.text(), reader.text(), reader.text(), reader.text()};
  if (!reader.is_whole() || outcome.empty()) refuse(where, "reading it ended without a result");
  if (outcome[0] == static_cast<char>(Outcome::cad_error)) throw CadError(std::move(parts));
  throw std::runtime_error(parts.what);
}

}  // namespace

IsolationLimits limits_for_file(const std::filesystem::path& file,
                                std::optional<std::chrono::milliseconds> time_limit, std::size_t least_bytes,
                                std::size_t bytes_of_a_byte) {
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(file, ignored);
  const std::uintmax_t bytes = ignored ? 0 : size;
  const std::chrono::milliseconds usual = std::chrono::seconds(20 + static_cast<long>(bytes >> 19));
  return {time_limit.value_or(usual), least_bytes + bytes_of_a_byte * bytes};
}

std::string run_isolated(std::string_view where, const IsolationLimits& limits,
                         const std::function<std::string()>& work) {
  std::array<int, 2> ends{};
  // Programs that other threads start must not keep the pipe open.
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse(where, std::strerror(errno));
  const pid_t parent = ::getpid();
  pid_t child = -1;
  {
    const ExchangeSession session;  // nobody is within OCCT's exchange at the moment of the fork
    child = ::fork();
    if (child == 0) live_as_child(parent, ends[1], std::string(where), limits, work);
  }
  const int fork_error = errno;
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    refuse(where, std::strerror(fork_error));
  }
  const auto deadline = Clock::now() + limits.time;
  const std::optional<std::string> bytes = receive(ends[0], deadline);
  ::close(ends[0]);
  const int status = wait_for(child, bytes ? deadline : Clock::now());
  const bool ran_out =
      !bytes || (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL));
  if (ran_out)
    refuse(where, fmt::format("OpenCASCADE does not come to an end within {} s",
                              std::chrono::duration<double>(limits.time).count()));
  if (WIFSIGNALED(status))
    refuse(where, fmt::format("it is broken: OpenCASCADE crashes on it (signal {})", WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0) refuse(where, "reading it ended without a result");
  return unpack(where, *bytes);
}

}  // namespace catoptric::cad::detail
