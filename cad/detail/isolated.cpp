#include "cad/detail/isolated.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>

#include "base/errors.h"
#include "cad/detail/byte_packet.h"
#include "cad/detail/occt_guard.h"

namespace catoptric::cad::detail {
namespace {

using Clock = std::chrono::steady_clock;
constexpr rlim_t most_memory = rlim_t{8}
                               << 30;  // the largest file we take, and OCCT needs some ten times its size

enum class Outcome : char { result = 'r', cad_error = 'c', other_error = 'o' };

std::string failure_packet(Outcome outcome, const ErrorParts& parts) {
  BytePacket packet;
  packet.put(std::string(1, static_cast<char>(outcome)));
  for (const std::string& part : {parts.what, parts.where, parts.why, parts.hint}) packet.put(part);
  return packet.bytes();
}

std::string packet_of(const std::function<std::string()>& work) {
  try {
    BytePacket packet;
    const std::string result = work();
    packet.put(std::string(1, static_cast<char>(Outcome::result)));
    packet.put(result);
    return packet.bytes();
  } catch (const CadError& error) {
    return failure_packet(Outcome::cad_error, error.parts());
  } catch (const std::exception& error) {
    return failure_packet(Outcome::other_error, {error.what(), "", "", ""});
  }
}

/// The child's whole life. It ends without exit handlers, which belong to the parent.
[[noreturn]] void live_as_child(int pipe, std::chrono::seconds limit,
                                const std::function<std::string()>& work) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGINT, SIGTERM, SIGPIPE})
    std::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // or it works on when the parent is killed
  const auto seconds = static_cast<rlim_t>(limit.count());
  const rlimit time{seconds, seconds};
  ::setrlimit(RLIMIT_CPU, &time);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
#ifndef __SANITIZE_ADDRESS__  // which reserves terabytes
  const rlimit memory{most_memory, most_memory};
  ::setrlimit(RLIMIT_AS, &memory);
#endif
  ExchangeSession::enter_child_process();
  const std::string bytes = packet_of(work);
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t now = ::write(pipe, bytes.data() + sent, bytes.size() - sent);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) ::_exit(1);
    sent += static_cast<std::size_t>(now);
  }
  ::_exit(0);
}

/// Everything the child sends until it closes the pipe, or nothing when the time is over.
std::optional<std::string> receive(int pipe, Clock::time_point deadline) {
  std::string bytes;
  std::array<char, 65536> buffer{};
  while (true) {
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
}

int wait_for(pid_t child) {
  int status = 0;
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

std::string run_isolated(std::string_view where, std::chrono::seconds limit,
                         const std::function<std::string()>& work) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) refuse(where, std::strerror(errno));
  pid_t child = -1;
  {
    const ExchangeSession session;  // nobody is within OCCT's exchange at the moment of the fork
    child = ::fork();
    if (child == 0) {
      ::close(ends[0]);
      live_as_child(ends[1], limit, work);
    }
  }
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    refuse(where, std::strerror(errno));
  }
  const std::optional<std::string> bytes = receive(ends[0], Clock::now() + limit);
  ::close(ends[0]);
  if (!bytes) ::kill(child, SIGKILL);
  const int status = wait_for(child);
  const bool ran_out =
      !bytes || (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL));
  if (ran_out) refuse(where, fmt::format("OpenCASCADE does not come to an end within {} s", limit.count()));
  if (WIFSIGNALED(status))
    refuse(where, fmt::format("it is broken: OpenCASCADE crashes on it (signal {})", WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0) refuse(where, "reading it ended without a result");
  return unpack(where, *bytes);
}

}  // namespace catoptric::cad::detail
