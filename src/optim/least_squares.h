#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "optim/outcome.h"
#include "optim/problem.h"

namespace catoptric::optim {

/// Minimise the norm of residuals(x) over the box of the variables.
struct LeastSquaresProblem {
  std::vector<Variable> variables;  ///< steps tell nothing but how large a variable is without bounds
  std::size_t residual_count = 0;
  /// Fills the residuals and, when `jacobian` is not null, their derivatives: row by row, a row for each
  /// residual, a column for each variable. False for a point that cannot be built. Never called outside the
  /// box; what it leaves infinite or not a number counts as false.
  std::function<bool(std::span<const double> x, std::span<double> residuals, double* jacobian)> evaluate;
};

struct LevenbergMarquardtOptions {
  long most_evaluations = 10000;  ///< calls of the problem's function, with derivatives or without
  long most_iterations = 200;
  double reach = 0;                   ///< the search ends when the norm is at or below
  double value_tolerance = 1e-12;     ///< relative change of the squared norm that ends the search
  double gradient_tolerance = 1e-14;  ///< greatest component of the squared norm's half gradient that ends it
  double step_tolerance = 1e-12;      ///< step over the length of x that ends the search
  double first_trust_radius = 1e4;    ///< reciprocal of the first damping; small: a cautious first step
  /// Called with the start and after every iteration; false ends the search with Ending::stopped.
  std::function<bool(const Iterate&)> progress;
  /// Asked before every evaluation; true ends the search with Ending::stopped.
  std::function<bool()> stop_requested;
};

/// Levenberg-Marquardt within bounds: damped steps by dense QR, projected onto the box with a line search.
/// Variables are in their natural units and residuals over their norm at the start, since Ceres' damping and
/// its ends take numbers for about 1.
/// One thread, the same bits every run.
/// @out   value, start_value and the history hold the norm of the residuals; divide the residuals by the root
///        of their number to make it their root mean square. An iteration is one damped step, a success one
///        that lowered the norm; the history's step is the trust radius over the first
/// @fails InputError as require_sound, or for no residuals; whatever the problem's function throws
/// @cost  per accepted step one evaluation with derivatives (more where a step must be shortened), and about
///        80 us in all beside the evaluations for 2 variables and 200 residuals
/// @from  Ceres Solver 2.1 (Agarwal, Mierle & others); Levenberg 1944, Marquardt 1963
Outcome levenberg_marquardt(const LeastSquaresProblem& problem, const LevenbergMarquardtOptions& options);

}  // namespace catoptric::optim
