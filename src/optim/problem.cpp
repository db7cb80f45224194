#include "optim/problem.h"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.h"
#include "base/float_traps.h"

namespace catoptric::optim {
namespace {

void require_sound(const Variable& variable) {
  const auto refuse = [&](std::string what, std::string why, std::string hint) {
    throw InputError(
        {std::move(what), fmt::format("variable '{}'", variable.name), std::move(why), std::move(hint)});
  };
  if (!std::isfinite(variable.start))
    refuse("the start is not a number", fmt::format("it is {}", variable.start), "give a finite start");
  if (!(variable.step > 0) || !std::isfinite(variable.step))
    refuse("the step cannot be used", fmt::format("{} is not positive and finite", variable.step),
           "a step of about a tenth of the variable's range");
  if (!(variable.lower <= variable.start && variable.start <= variable.upper))
    refuse("the start lies outside its bounds",
           fmt::format("{} is not within [{}, {}]", variable.start, variable.lower, variable.upper),
           "widen the bounds or move the start");
}

}  // namespace

double natural_unit(const Variable& variable) {
  const double width = variable.upper - variable.lower;
  return std::exp2(std::ilogb(std::isfinite(width) && width > 0 ? width : variable.step));
}

void require_sound(const Problem& problem) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (problem.variables.empty())
    throw InputError({"there is nothing to search", "", "no variable is free", "name at least one variable"});
  if (!problem.evaluate)
    throw InputError({"there is nothing to search", "", "the problem has no objective", "set one"});
  for (const Variable& variable : problem.variables) require_sound(variable);
}

void require_finite_box(const Problem& problem) {
  for (const Variable& variable : problem.variables)
    if (!std::isfinite(variable.lower) || !std::isfinite(variable.upper))
      throw InputError({"the search has no end", fmt::format("variable '{}'", variable.name),
                        fmt::format("this method looks over the whole box, and [{}, {}] is not finite",
                                    variable.lower, variable.upper),
                        "give both bounds"});
}

}  // namespace catoptric::optim
