#pragma once

#include <string>
#include <vector>

namespace catoptric::optim {

enum class Ending {
  converged,         ///< the step fell below its limit
  evaluation_limit,  ///< stopped by the budget
  iteration_limit,
  stopped,         ///< the caller asked to stop
  no_start,        ///< the objective has no finite value at the start
  target_reached,  ///< the value asked for, or a better one
  failed,          ///< the method itself could not go on
};

/// The state of a search after one of its iterations.
struct Iterate {
  long k;                 ///< successes so far: index in the sequence of ever-improving solutions
  long iteration;         ///< iterations so far, those that only reduced the step included
  long evaluations;       ///< objective values computed so far (cache hits not counted)
  double step;            ///< present step as a share of the first, after this iteration's reduction; 1 where
                          ///< a search has no step of its own
  std::string move;       ///< "start", "exploratory", "pattern", "reduce"; "step" of other searches
  std::vector<double> x;  ///< best point so far
  double value;           ///< its objective
};

/// How a search ended; `best` is never worse than the start.
struct Outcome {
  Ending ending;
  std::string sentence;      ///< the ending in words
  std::vector<double> best;  ///< the start when the ending is no_start
  double value = 0;          ///< infinite when the ending is no_start
  double start_value = 0;
  long successes = 0;   ///< the paper's k
  long iterations = 0;  ///< the last one may have been broken off by a limit or a stop
  long evaluations = 0;
  long cache_hits = 0;
  long restarts = 0;             ///< of multi_start: searches begun after the first
  std::vector<Iterate> history;  ///< the start, then one entry per iteration that improved or reduced
};

}  // namespace catoptric::optim
