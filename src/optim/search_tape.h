#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "optim/least_squares.h"
#include "optim/problem.h"

namespace catoptric::optim {

/// A design vector that a search asked about, and the answer.
struct Answer {
  std::vector<double> x;
  double value;  ///< the objective; infinite where there is none
  bool operator==(const Answer&) const = default;
};

/// All that a search was told so far, in order. Every search here is a function of the answers it gets, so
/// this is its whole state: run again with the same options, it is told from the tape what it asks again,
/// without computing it, and then goes on to the same bits as a search never broken off.
class SearchTape {
 public:
  /// @in known  answers of the search that was broken off
  explicit SearchTape(std::vector<Answer> known = {}) : answers_(std::move(known)) {}
  SearchTape(const SearchTape&) = delete;
  SearchTape& operator=(const SearchTape&) = delete;

  /// Called after every answer that was computed and not known before.
  std::function<void(const SearchTape&)> grown;

  /// The next known answer, or nothing when what follows is new.
  /// @fails InputError when the next known answer is to another question: the tape is another search's
  std::optional<double> recall(std::span<const double> x);

  /// Adds an answer.
  /// @in    recall() has just given nothing
  void record(std::span<const double> x, double value);

  const std::vector<Answer>& answers() const { return answers_; }

  /// The best answer so far; null where no value is finite.
  const Answer* best() const;

 private:
  std::vector<Answer> answers_;
  std::size_t at_ = 0;
};

/// The problem with a tape between it and the search.
/// @in    tape outlives the result; one search at a time
/// @fails when called: InputError as recall()
Problem remembering(const Problem& problem, SearchTape& tape);

/// The same for a fit: known questions are checked and computed again, since residuals and derivatives take
/// more room than the time to compute them is worth. The tape's value is the residuals' norm.
LeastSquaresProblem remembering(const LeastSquaresProblem& problem, SearchTape& tape);

}  // namespace catoptric::optim
