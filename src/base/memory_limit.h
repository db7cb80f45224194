#pragma once

#include <cstdint>
#include <optional>

namespace catoptric {

/// Memory that this process may still take before the system, its control group or its own limit says no;
/// nothing where the system does not tell.
/// @from  /proc/meminfo MemAvailable, cgroup v2 memory.max and memory.current, RLIMIT_AS
std::optional<std::uint64_t> available_memory_bytes();

}  // namespace catoptric
