#pragma once

#include <functional>

#include "optim/outcome.h"
#include "optim/problem.h"

namespace catoptric::optim {

struct HookeJeevesOptions {
  double acceleration = 1.0;    ///< alpha of the pattern step a = x_k + alpha (x_k - x_{k-1})
  double reduction = 0.5;       ///< the step is multiplied by this after a failed iteration, in (0, 1)
  double smallest_step = 1e-3;  ///< the search ends when the step falls below this share of the first
  long most_evaluations = 10000;
  long most_iterations = 1000;
  /// Called after every iterate; false ends the search with Ending::stopped.
  std::function<bool(const Iterate&)> progress;
};

/// Pattern search exactly as paper section 4.5: exploratory moves per coordinate (plus first, then minus),
/// pattern step with acceleration, temporary acceptance of the pattern point, step reduction. Every point is
/// evaluated once.
/// @fails InputError for an empty problem, a step that is not positive, or a start outside its bounds
/// @from  Hooke & Jeeves 1961; paper section 4.5
Outcome hooke_jeeves(const Problem& problem, const HookeJeevesOptions& options);

}  // namespace catoptric::optim
