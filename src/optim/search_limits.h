#pragma once

#include <functional>
#include <limits>

#include "optim/outcome.h"

namespace catoptric::optim {

/// What ends a search from outside, and who watches it.
struct SearchLimits {
  long most_evaluations = 10000;
  double reach = -std::numeric_limits<double>::infinity();  ///< a value at or below ends the search
  /// Called with the start and after every improvement; false ends the search with Ending::stopped.
  std::function<bool(const Iterate&)> progress = {};
  /// Asked before every evaluation but the first; true ends the search with Ending::stopped.
  std::function<bool()> stop_requested = {};
};

}  // namespace catoptric::optim
