#include "optim/search_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "base/errors.h"

namespace catoptric::optim {
namespace {

/// Reads the state from its beginning, then writes at its end.
class Tape {
 public:
  explicit Tape(SearchState& state) : state_(state) {
    if (state.points.size() != state.answers.size())
      fail(fmt::format("{} points and {} answers", state.points.size(), state.answers.size()));
  }

  /// The next answer, or null when the state has no more.
  const std::vector<double>* next(std::span<const double> x) {
    if (at_ >= state_.points.size()) return nullptr;
    if (!std::ranges::equal(state_.points[at_], x)) fail(fmt::format("evaluation {} differs", at_ + 1));
    return &state_.answers[at_++];
  }

  void append(std::span<const double> x, std::vector<double> answer) {
    state_.points.emplace_back(x.begin(), x.end());
    state_.answers.push_back(std::move(answer));
    ++at_;
  }

  [[noreturn]] static void fail(std::string why) {
    throw InputError({"the saved search is not this one", "search state", std::move(why),
                      "use the same scene, method, seed and program, or start anew"});
  }

 private:
  SearchState& state_;
  std::size_t at_ = 0;
};

}  // namespace

Problem remembering(const Problem& problem, SearchState& state) {
  return {problem.variables,
          [&problem, tape = std::make_shared<Tape>(state)](std::span<const double> x) -> double {
            if (const auto* answer = tape->next(x)) {
              if (answer->size() != 1) Tape::fail("its answers are not single numbers");
              return answer->front();
            }
            const double value = problem.evaluate(x);
            tape->append(x, {value});
            return value;
          }};
}

LeastSquaresProblem remembering(const LeastSquaresProblem& problem, SearchState& state) {
  const auto evaluate = [&problem, tape = std::make_shared<Tape>(state)](
                            std::span<const double> x, std::span<double> residuals, double* jacobian) {
    const std::size_t derivatives = jacobian ? residuals.size() * x.size() : 0;
    if (const auto* answer = tape->next(x)) {
      if (answer->empty()) return false;
      if (answer->size() != residuals.size() + derivatives) Tape::fail("its answers have another length");
      std::copy_n(answer->begin(), residuals.size(), residuals.begin());
      std::copy_n(answer->begin() + static_cast<std::ptrdiff_t>(residuals.size()), derivatives, jacobian);
      return true;
    }
    const bool built = problem.evaluate(x, residuals, jacobian);
    std::vector<double> answer;
    if (built) {
      answer.assign(residuals.begin(), residuals.end());
      answer.insert(answer.end(), jacobian, jacobian + derivatives);
    }
    tape->append(x, std::move(answer));
    return built;
  };
  return {problem.variables, problem.residual_count, evaluate};
}

}  // namespace catoptric::optim
