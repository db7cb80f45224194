#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace catoptric::optim {

/// A decision variable in the caller's own unit.
struct Variable {
  std::string name;
  double start;
  double step;  ///< first step, > 0
  double lower, upper;
};

/// Minimise evaluate(x) over the box of the variables. `evaluate` may return infinity for a point that cannot
/// be built; it is never called outside the box.
struct Problem {
  std::vector<Variable> variables;
  std::function<double(std::span<const double>)> evaluate;
};

}  // namespace catoptric::optim
