#pragma once

#include <vector>

#include "optim/least_squares.h"
#include "optim/problem.h"

namespace catoptric::optim {

/// All that a search was told so far: a plain record that can be written to a file and read back. Every
/// search here is a function of the answers it gets, so this is its whole state.
struct SearchState {
  std::vector<std::vector<double>> points;
  /// One number for an objective; the residuals, then their derivatives if asked for, of a fit; empty where
  /// no residuals could be built.
  std::vector<std::vector<double>> answers;
};

/// The problem with a memory: the first questions are answered from `state` without computing anything, later
/// ones are computed and added to it. So a search that was broken off after N evaluations and is run again
/// with its state, the same options and a larger budget goes on where it was, to the same bits as one never
/// broken off; what it asks before is replayed in microseconds.
/// @in    problem and state outlive the result; one search at a time
/// @fails when called: InputError when a question is not the one that the state has an answer to, so the
/// state
///        is that of another search
Problem remembering(const Problem& problem, SearchState& state);
LeastSquaresProblem remembering(const LeastSquaresProblem& problem, SearchState& state);

}  // namespace catoptric::optim
