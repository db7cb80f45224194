#pragma once

#include <atomic>

namespace catoptric::cli {

/// Becomes true at the first SIGINT, SIGTERM or SIGUSR1; a second one ends the process at once.
const std::atomic<bool>& stop_on_signal();

}  // namespace catoptric::cli
