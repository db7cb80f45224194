#pragma once

#include <atomic>

namespace catoptric::cli {

/// Becomes true at the first SIGINT or SIGTERM; a second one ends the process at once.
const std::atomic<bool>& stop_on_signal();

}  // namespace catoptric::cli
