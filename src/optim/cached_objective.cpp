#include "optim/cached_objective.h"

#include <cmath>
#include <limits>

#include "base/contract.h"

namespace catoptric::optim {
namespace {

[[maybe_unused]] bool inside_box(const Problem& problem, std::span<const double> x) {
  if (x.size() != problem.variables.size()) return false;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!(problem.variables[i].lower <= x[i] && x[i] <= problem.variables[i].upper)) return false;
  return true;
}

}  // namespace

std::optional<double> CachedObjective::recall(std::span<const double> x) {
  const auto found = known_.find({x.begin(), x.end()});
  if (found == known_.end()) return {};
  ++cache_hits_;
  return found->second;
}

double CachedObjective::compute(std::span<const double> x) {
  CATOPTRIC_EXPECTS(inside_box(problem_, x));
  const double answer = problem_.evaluate(x);
  const double value = std::isnan(answer) ? std::numeric_limits<double>::infinity() : answer;
  ++evaluations_;
  known_.emplace(std::vector<double>(x.begin(), x.end()), value);
  return value;
}

}  // namespace catoptric::optim
