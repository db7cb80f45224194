#include "report/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <thread>

extern char** environ;

namespace catoptric::report {
namespace {

using Clock = std::chrono::steady_clock;

/// A pipe whose ends close themselves, and are not handed to children by accident.
class Pipe {
 public:
  Pipe() { open_ = ::pipe2(ends_.data(), O_CLOEXEC) == 0; }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  bool open() const { return open_; }
  int reading() const { return ends_[0]; }
  int writing() const { return ends_[1]; }
  void close_end(std::size_t end) {
    if (ends_[end] >= 0) ::close(ends_[end]);
    ends_[end] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
  bool open_;
};

class SpawnActions {
 public:
  SpawnActions() { posix_spawn_file_actions_init(&actions_); }
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  posix_spawn_file_actions_t* get() { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

/// The present environment, but in the C locale, so that numbers have decimal points.
std::vector<std::string> plain_environment() {
  std::vector<std::string> variables{"LC_ALL=C.UTF-8"};
  for (char** variable = environ; *variable; ++variable)
    if (!std::string_view(*variable).starts_with("LC_ALL=")) variables.emplace_back(*variable);
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> list;
  for (std::string& string : strings) list.push_back(string.data());
  list.push_back(nullptr);
  return list;
}

/// Reads both pipes until the child has closed them or the time is over.
void collect(Pipe& out, Pipe& err, ChildResult& result, Clock::time_point deadline) {
  std::array<pollfd, 2> watched{pollfd{out.reading(), POLLIN, 0}, pollfd{err.reading(), POLLIN, 0}};
  std::array<std::string*, 2> texts{&result.output, &result.errors};
  std::array<char, 65536> buffer;
  while (watched[0].fd >= 0 || watched[1].fd >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return;
    const int ready = ::poll(watched.data(), watched.size(), static_cast<int>(left));
    if (ready < 0 && errno != EINTR) return;
    for (std::size_t i = 0; ready > 0 && i < watched.size(); ++i) {
      if (watched[i].revents == 0) continue;
      const ssize_t got = ::read(watched[i].fd, buffer.data(), buffer.size());
      if (got > 0) texts[i]->append(buffer.data(), static_cast<std::size_t>(got));
      if (got == 0 || (got < 0 && errno != EINTR)) watched[i].fd = -1;
    }
  }
}

/// The exit code; a child that has closed its outputs but does not end is killed when the time is over.
int wait_for(pid_t child, Clock::time_point deadline) {
  int status = 0;
  bool killed = false;
  for (;;) {
    const pid_t ended = ::waitpid(child, &status, killed ? 0 : WNOHANG);
    if (ended == child) break;
    if (ended < 0 && errno != EINTR) return -1;
    if (!killed && Clock::now() >= deadline) {
      ::kill(child, SIGKILL);
      killed = true;
    } else if (!killed) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

ChildResult run_child(const std::vector<std::string>& command, std::chrono::milliseconds time_limit) {
  ChildResult result{ChildResult::End::failed, 0, {}, {}};
  Pipe out, err;
  if (!out.open() || !err.open()) {
    result.errors = std::strerror(errno);
    return result;
  }
  SpawnActions actions;
  posix_spawn_file_actions_addopen(actions.get(), STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(actions.get(), out.writing(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(actions.get(), err.writing(), STDERR_FILENO);
  std::vector<std::string> arguments = command, variables = plain_environment();
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, command.front().c_str(), actions.get(), nullptr,
                                     pointers(arguments).data(), pointers(variables).data());
  if (failure != 0) {
    result.end = failure == ENOENT ? ChildResult::End::not_found : ChildResult::End::failed;
    result.errors = std::strerror(failure);
    return result;
  }
  out.close_end(1);
  err.close_end(1);
  const auto deadline = Clock::now() + time_limit;
  collect(out, err, result, deadline);
  result.exit_code = wait_for(child, deadline);
  result.end = Clock::now() < deadline ? ChildResult::End::finished : ChildResult::End::timed_out;
  return result;
}

}  // namespace catoptric::report
