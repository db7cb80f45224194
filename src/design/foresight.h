#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <vector>

#include "base/ranks.h"
#include "optim/outcome.h"
#include "optim/problem.h"

namespace catoptric::design {

/// Evaluations of one search that ranks compute side by side. A search is a function of the answers that it
/// gets: run once more on those it has had so far, and told of every other point that it is no better, it
/// comes to the points that it may ask for next. These are computed together, and the search itself is told
/// of each when it comes there. Of a population these are the next members, of a pattern the moves that
/// follow when none is better; what is computed in vain costs nothing but ranks that had nothing to do. Run
/// once more and told the contrary, the search shows which points it asks for whatever the answers (the rest
/// of a generation): these are computed in one go, so that no rank waits while there are any.
/// @from  speculative computation: Burton 1985, IEEE Trans. Comput. C-34(12):1190
class Foresight {
 public:
  /// The whole search on a problem, quietly, until `enough`.
  using Rehearse = std::function<void(const optim::Problem&, const std::function<bool()>& enough)>;

  /// @in   rehearse: may be empty; stop: this process's, may be null
  /// @out  stopped: becomes true, on all ranks at the same evaluation, once one of them has been stopped
  Foresight(Ranks& ranks, optim::Problem light, Rehearse rehearse, const std::atomic<bool>* stop,
            std::atomic<bool>& stopped)
      : ranks_(ranks),
        light_(std::move(light)),
        rehearse_(std::move(rehearse)),
        stop_(stop),
        stopped_(stopped) {}

  /// The value at x; all ranks ask for the same.
  /// @fails Interrupted where the evaluation was broken off; whatever it throws
  double evaluate(std::span<const double> x);

  /// An answer that the search got from elsewhere.
  void know(std::span<const double> x, double value) { known_[{x.begin(), x.end()}] = value; }

 private:
  using Points = std::vector<std::vector<double>>;
  Points asked_next(std::size_t most, const std::function<double(std::size_t)>& answer) const;
  Points next_points(std::span<const double> x) const;

  Ranks& ranks_;
  optim::Problem light_;
  Rehearse rehearse_;
  const std::atomic<bool>* stop_;
  std::map<std::vector<double>, double> known_;
  std::atomic<bool>& stopped_;
};

}  // namespace catoptric::design
