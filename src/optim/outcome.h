#pragma once

#include <string>
#include <vector>

namespace catoptric::optim {

enum class Ending {
  converged,         ///< the step fell below its limit
  evaluation_limit,  ///< stopped by the budget
  iteration_limit,
  stopped,   ///< the caller asked to stop
  no_start,  ///< the objective has no finite value at the start
};

/// One accepted or tried iterate of a search.
struct Iterate {
  long k;                 ///< successes so far: index in the sequence of ever-improving solutions
  long iteration;         ///< exploratory + pattern steps so far
  long evaluations;       ///< objective values computed so far (cache hits not counted)
  double step;            ///< present step as a share of the first
  std::string move;       ///< "start", "exploratory", "pattern", "reduce"
  std::vector<double> x;  ///< best point so far
  double value;           ///< its objective
};

/// How a search ended; `best` is never worse than the start.
struct Outcome {
  Ending ending;
  std::string sentence;  ///< the ending in words
  std::vector<double> best;
  double value = 0;
  double start_value = 0;
  long successes = 0;  ///< the paper's k
  long iterations = 0;
  long evaluations = 0;
  long cache_hits = 0;
  std::vector<Iterate> history;
};

}  // namespace catoptric::optim
