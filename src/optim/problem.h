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
  double step;          ///< first step, > 0
  double lower, upper;  ///< may be infinite; lower = start = upper makes a variable that never moves
};

/// Minimise evaluate(x) over the box of the variables. `evaluate` may return infinity for a point that cannot
/// be built (a NaN counts as infinity); it is never called outside the box.
struct Problem {
  std::vector<Variable> variables;
  std::function<double(std::span<const double>)> evaluate;
};

/// What a search measures a variable in, where its method would mind the caller's unit: a power of two near
/// the width of the box, or near the step where the box has no end. So the same problem in other units, by
/// powers of two, is the same to the last bit.
double natural_unit(const Variable& variable);

/// Checks what every search relies on.
/// @fails InputError, naming the variable, for an empty problem, a missing objective, a step that is not
///        positive and finite, a start that is not finite or outside its bounds
void require_sound(const Problem& problem);

/// For searches that look over the whole box.
/// @fails InputError, naming the variable, when a bound is infinite
void require_finite_box(const Problem& problem);

}  // namespace catoptric::optim
