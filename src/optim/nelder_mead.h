#pragma once

#include "optim/outcome.h"
#include "optim/problem.h"
#include "optim/search_limits.h"

namespace catoptric::optim {

struct NelderMeadOptions {
  SearchLimits limits;
  double step_tolerance = 1e-8;    ///< size of the simplex over x that ends the search
  double value_tolerance = 1e-12;  ///< difference of the simplex's values over the value that ends it
};

/// Downhill simplex within bounds, from the start with the variables' steps as its first edges. Local; no
/// random numbers.
/// @fails InputError as require_sound, or for a budget below 1; whatever the objective throws
/// @from  Johnson, NLopt 2.7 (LN_NELDERMEAD); Nelder & Mead 1965, bounds after Richardson & Kuester 1973
Outcome nelder_mead(const Problem& problem, const NelderMeadOptions& options);

}  // namespace catoptric::optim
