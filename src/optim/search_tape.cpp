#include "optim/search_tape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"

namespace catoptric::optim {

std::optional<double> SearchTape::recall(std::span<const double> x) {
  if (at_ >= answers_.size()) return std::nullopt;
  const Answer& known = answers_[at_];
  if (!std::ranges::equal(known.x, x))
    throw InputError({"the saved search is not this one", "checkpoint",
                      fmt::format("its evaluation {} was of another design", at_ + 1),
                      "use the same scene, method and seed, or start anew"});
  ++at_;
  return known.value;
}

void SearchTape::record(std::span<const double> x, double value) {
  answers_.push_back({{x.begin(), x.end()}, value});
  at_ = answers_.size();
  if (grown) grown(*this);
}

const Answer* SearchTape::best() const {
  const auto least = std::ranges::min_element(answers_, {}, [](const Answer& answer) {
    return std::isfinite(answer.value) ? answer.value : std::numeric_limits<double>::infinity();
  });
  return least == answers_.end() || !std::isfinite(least->value) ? nullptr : &*least;
}

Problem remembering(const Problem& problem, SearchTape& tape) {
  return {problem.variables, [evaluate = problem.evaluate, &tape](std::span<const double> x) {
            if (const auto known = tape.recall(x)) return *known;
            double value = evaluate(x);
            if (std::isnan(value))
              value = std::numeric_limits<double>::infinity();  // to every search the same
            tape.record(x, value);
            return value;
          }};
}

LeastSquaresProblem remembering(const LeastSquaresProblem& problem, SearchTape& tape) {
  const auto asked = [evaluate = problem.evaluate, &tape](std::span<const double> x,
                                                          std::span<double> residuals, double* jacobian) {
    const bool known = tape.recall(x).has_value();
    const bool built = evaluate(x, residuals, jacobian);
    if (known) return built;
    double square = 0;
    for (const double residual : residuals) square += residual * residual;
    tape.record(x, built ? std::sqrt(square) : std::numeric_limits<double>::infinity());
    return built;
  };
  return {problem.variables, problem.residual_count, asked};
}

}  // namespace catoptric::optim
