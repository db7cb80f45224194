#include "optim/multi_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>

#include "base/random_stream.h"

namespace catoptric::optim {
namespace {

/// Points of the unit cube, one after the other.
class Starts {
 public:
  Starts(const MultiStartOptions& options, std::size_t dimension)
      : options_(options), sobol_(dimension), stream_(options.seed, Purpose::search, 0) {
    for (std::size_t i = 0; i < dimension; ++i) shift_.push_back(stream_.uniform());
  }

  /// A point of the box.
  std::vector<double> next(const std::vector<Variable>& variables) {
    std::vector<double> x;
    for (std::size_t i = 0; i < variables.size(); ++i) {
      const Variable& variable = variables[i];
      const double at = variable.lower + share(i) * (variable.upper - variable.lower);
      x.push_back(std::clamp(at, variable.lower, variable.upper));
    }
    return x;
  }

 private:
  double share(std::size_t i) {
    if (options_.points == StartPoints::random) return stream_.uniform();
    const double sum = RandomStream::to_unit(sobol_()) + shift_[i];  // a rotation keeps the evenness
    return sum - std::floor(sum);
  }

  const MultiStartOptions& options_;
  boost::random::sobol sobol_;
  RandomStream stream_;
  std::vector<double> shift_;
};

/// Adds a search to the sum of those before.
void merge(Outcome& all, Outcome next) {
  const bool first = all.history.empty() && all.evaluations == 0;
  if (first) all.start_value = next.start_value;
  for (Iterate& each : next.history) {
    if (!all.history.empty() && !(each.value < all.history.back().value)) continue;
    each.evaluations += all.evaluations;
    each.iteration += all.iterations;
    each.k = static_cast<long>(all.history.size());
    all.history.push_back(std::move(each));
  }
  all.evaluations += next.evaluations;
  all.iterations += next.iterations;
  all.cache_hits += next.cache_hits;
  all.successes = std::max(0L, static_cast<long>(all.history.size()) - 1);
  if (!first && !(next.value < all.value)) return;
  all.value = next.value;
  all.best = std::move(next.best);
}

}  // namespace

Outcome multi_start(const Problem& problem, const std::function<Outcome(const StartedSearch&)>& search,
                    const MultiStartOptions& options) {
  require_sound(problem);
  require_finite_box(problem);
  Problem at_start = problem;
  Starts starts(options, problem.variables.size());
  Outcome all{};
  while (true) {
    SearchLimits left = options.limits;
    left.most_evaluations -= all.evaluations;
    Outcome one = search({at_start, left, options.seed + static_cast<std::uint64_t>(all.restarts)});
    all.ending = one.ending;
    all.sentence = one.sentence;
    merge(all, std::move(one));
    if (all.ending == Ending::target_reached || all.ending == Ending::stopped) break;
    if (options.limits.stop_requested && options.limits.stop_requested()) {
      all.ending = Ending::stopped;
      all.sentence = "stopped on request";
      break;
    }
    if (all.evaluations >= options.limits.most_evaluations) {
      all.ending = Ending::evaluation_limit;
      all.sentence = fmt::format("stopped by the limit of {} evaluations", all.evaluations);
      break;
    }
    if (all.restarts >= options.most_restarts) break;
    ++all.restarts;
    const std::vector<double> x = starts.next(problem.variables);
    for (std::size_t i = 0; i < x.size(); ++i) at_start.variables[i].start = x[i];
  }
  if (all.restarts > 0) all.sentence += fmt::format("; best of {} starts", all.restarts + 1);
  return all;
}

}  // namespace catoptric::optim
