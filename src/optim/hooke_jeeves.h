#pragma once

#include <functional>
#include <limits>

#include "optim/outcome.h"
#include "optim/problem.h"

namespace catoptric::optim {

/// What an iteration does after one that failed. The paper leaves it open; see README.md.
enum class PatternAfterFailure {
  dropped,  ///< x_k did not move, so there is no direction: exploratory search only (Hooke & Jeeves; Torczon)
  kept,     ///< the last direction x_k - x_{k-1} between different iterates is tried again
};

struct HookeJeevesOptions {
  double acceleration = 1.0;    ///< alpha of the pattern step a = x_k + alpha (x_k - x_{k-1}), >= 0
  double reduction = 0.5;       ///< the step is multiplied by this after a failed iteration, in (0, 1)
  double smallest_step = 1e-3;  ///< the search ends when the step falls below this share of the first, > 0:
                                ///< ten halvings, as in Table 2 of the paper
  long most_evaluations = 10000;
  long most_iterations = 1000;
  double reach =
      -std::numeric_limits<double>::infinity();  ///< an iteration that ends at or below is the last
  PatternAfterFailure pattern_after_failure = PatternAfterFailure::dropped;
  /// Called with the start and after every iteration that improved or reduced; false ends the search with
  /// Ending::stopped.
  std::function<bool(const Iterate&)> progress;
  /// Asked before every evaluation but the first; true ends the search with Ending::stopped.
  std::function<bool()> stop_requested;
};

/// Pattern search exactly as paper section 4.5: exploratory moves per coordinate (plus first, then minus),
/// pattern step with acceleration, temporary acceptance of the pattern point, step reduction. Every point is
/// evaluated once. A move that leaves the box is clamped to the bound it crosses, and is no move if the
/// variable stands there already. What an improving iteration found before a limit broke it off is kept.
/// @out   an iteration is one attempt to find x_{k+1}: the pattern step and, if it fails, the exploratory
///        search around x_k. It either succeeds (k grows) or reduces the step, so iterations = successes +
///        reductions
/// @fails InputError for an empty problem, a step that is not positive, a start outside its bounds, or an
///        option out of its range; whatever the objective throws
/// @cost  an iteration needs at most 2 (2 n) + 1 evaluations
/// @from  Hooke & Jeeves 1961; paper section 4.5, eqs. 9 and 10
Outcome hooke_jeeves(const Problem& problem, const HookeJeevesOptions& options);

}  // namespace catoptric::optim
