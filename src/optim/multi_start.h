#pragma once

#include <cstdint>
#include <functional>

#include "optim/outcome.h"
#include "optim/problem.h"
#include "optim/search_limits.h"

namespace catoptric::optim {

enum class StartPoints {
  sobol,   ///< low-discrepancy points, shifted at random by the seed: no two starts near each other
  random,  ///< independent
};

struct MultiStartOptions {
  SearchLimits limits;       ///< of all starts together
  long most_restarts = 100;  ///< after the first search, which begins at the problem's own start
  StartPoints points = StartPoints::sobol;
  std::uint64_t seed = 1;
};

/// One search of many: its problem begins at another point of the box.
struct StartedSearch {
  const Problem& problem;
  SearchLimits limits;  ///< what is left of the budget, with the value to reach
  std::uint64_t seed;   ///< another for each start
};

/// Runs a search from the problem's start, then from points all over the box, until a value is reached, the
/// budget is spent or the restarts are used up; the best of all is the outcome.
/// @out   counts are sums over the searches, Outcome::restarts the searches begun after the first; the
/// history
///        holds what improved on all before
/// @fails InputError as require_sound, for a variable without two finite bounds; whatever the search throws
Outcome multi_start(const Problem& problem, const std::function<Outcome(const StartedSearch&)>& search,
                    const MultiStartOptions& options);

}  // namespace catoptric::optim
