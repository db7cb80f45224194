#include "fuzz/support/input_batch.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

namespace catoptric::fuzz {
namespace {

/// What the child leaves behind when it dies.
struct Shared {
  std::uint64_t done;
  std::uint64_t counts[16];
  char finding[1024];
};

Shared* shared_memory() {
  static Shared* const memory = [] {
    void* const place =
        ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED) throw std::runtime_error("no shared memory");
    return static_cast<Shared*>(place);
  }();
  return memory;
}

/// The timer's signal ends the process.
void set_timer(std::chrono::milliseconds limit) {
  itimerval timer{};
  timer.it_value.tv_sec = limit.count() / 1000;
  timer.it_value.tv_usec = limit.count() % 1000 * 1000;
  ::setitimer(ITIMER_PROF, &timer, nullptr);
}

void set_up_child() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{0, 0}, memory{rlim_t{2} << 30, rlim_t{2} << 30};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::setrlimit(RLIMIT_AS, &memory);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
}

}  // namespace

BatchProgress run_batch(std::uint64_t count, std::chrono::milliseconds limit,
                        const std::function<std::string(std::uint64_t, unsigned& ended)>& try_one,
                        std::uint64_t (&counts)[16]) {
  Shared& shared = *shared_memory();
  shared = {};
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    set_up_child();
    for (std::uint64_t i = 0; i < count; ++i) {
      set_timer(limit);
      unsigned ended = 0;
      const std::string finding = try_one(i, ended);
      ++shared.counts[ended];
      ++shared.done;
      std::strncpy(shared.finding, finding.c_str(), sizeof shared.finding - 1);
      if (!finding.empty()) break;
    }
    ::_exit(0);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  for (std::size_t i = 0; i < 16; ++i) counts[i] += shared.counts[i];
  return {shared.done, !WIFEXITED(status), shared.finding};
}

}  // namespace catoptric::fuzz
