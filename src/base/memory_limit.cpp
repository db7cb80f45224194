#include "base/memory_limit.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace catoptric {
namespace {

/// A file that holds one number; a cgroup without limit says "max".
std::optional<std::uint64_t> number_in(const std::string& file) {
  std::uint64_t number = 0;
  if (std::ifstream in(file); in >> number) return number;
  return std::nullopt;
}

std::optional<std::uint64_t> left_in_system() {
  std::ifstream in("/proc/meminfo");
  for (std::string name, unit; in >> name;) {
    std::uint64_t kibibytes = 0;
    if (name == "MemAvailable:" && in >> kibibytes) return kibibytes * 1024;
    std::getline(in, unit);
  }
  return std::nullopt;
}

/// Of this process's own group; limits of those above it are the system's to tell.
std::optional<std::uint64_t> left_in_group() {
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("0::")) continue;
    const std::string folder = "/sys/fs/cgroup" + line.substr(3);
    const auto most = number_in(folder + "/memory.max"), now = number_in(folder + "/memory.current");
    if (most && now) return *most - std::min(*most, *now);
  }
  return std::nullopt;
}

std::optional<std::uint64_t> left_in_own_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  const std::uint64_t pages = number_in("/proc/self/statm").value_or(0);
  const std::uint64_t now = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, now);
}

}  // namespace

std::optional<std::uint64_t> available_memory_bytes() {
  std::optional<std::uint64_t> least;
  for (const auto& left : {left_in_system(), left_in_group(), left_in_own_limit()})
    if (left && (!least || *left < *least)) least = left;
  return least;
}

}  // namespace catoptric
