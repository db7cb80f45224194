#include "optim/tally.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"

namespace catoptric::optim {
namespace {

constexpr double no_value = std::numeric_limits<double>::infinity();
/// Above every value of use, and differences of two such are still finite.
constexpr double unbuildable = std::numeric_limits<double>::max() / 4;

}  // namespace

Tally::Tally(const Problem& problem, const SearchLimits& limits, long evaluations_per_iteration)
    : problem_(problem), limits_(limits), per_iteration_(evaluations_per_iteration) {
  require_sound(problem);
  if (limits.most_evaluations < 1)
    throw InputError({fmt::format("most_evaluations cannot be {}", limits.most_evaluations), "search",
                      "it must be 1 or more", "leave it out to use the default"});
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const Variable& variable = problem.variables[i];
    if (variable.lower < variable.upper) free_.push_back(i);
    outcome_.best.push_back(variable.start);
  }
  outcome_.value = outcome_.start_value = no_value;
}

template <class Get>
std::vector<double> Tally::of_free(Get get) const {
  std::vector<double> values;
  for (const std::size_t i : free_)
    values.push_back(get(problem_.variables[i]) / natural_unit(problem_.variables[i]));
  return values;
}

std::vector<double> Tally::start() const {
  return of_free([](const Variable& variable) { return variable.start; });
}
std::vector<double> Tally::step() const {
  return of_free([](const Variable& variable) { return variable.step; });
}
std::vector<double> Tally::lower() const {
  return of_free([](const Variable& variable) { return variable.lower; });
}
std::vector<double> Tally::upper() const {
  return of_free([](const Variable& variable) { return variable.upper; });
}

bool Tally::found() const { return outcome_.value < no_value; }

bool Tally::begin() {
  const std::vector<double> x = outcome_.best;
  outcome_.start_value = value_at(x, "start");
  if (free_.empty() && !ending_) ending_ = found() ? Ending::converged : Ending::no_start;
  return !ending_;
}

double Tally::start_value() const { return std::min(outcome_.start_value, unbuildable); }

double Tally::evaluate(std::span<const double> free_values) {
  std::vector<double> x;
  for (const Variable& variable : problem_.variables) x.push_back(variable.start);
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const Variable& variable = problem_.variables[free_[i]];
    x[free_[i]] = std::clamp(free_values[i] * natural_unit(variable), variable.lower, variable.upper);
  }
  if (!ending_) {
    if (found() && x == outcome_.best) {
      ++outcome_.cache_hits;
      return outcome_.value;
    }
    if (outcome_.evaluations >= limits_.most_evaluations)
      ending_ = Ending::evaluation_limit;
    else if (limits_.stop_requested && limits_.stop_requested())
      ending_ = Ending::stopped;
  }
  if (ending_) throw Over{};
  const double value = value_at(x, "step");
  if (ending_) throw Over{};
  return std::min(value, unbuildable);
}

double Tally::value_at(const std::vector<double>& x, const char* move) {
  const double answer = problem_.evaluate(x);
  const double value = std::isnan(answer) ? no_value : answer;
  ++outcome_.evaluations;
  take(x, value, move);
  return value;
}

void Tally::take(const std::vector<double>& x, double value, const char* move) {
  outcome_.iterations = (outcome_.evaluations - 1) / per_iteration_;
  if (!(value < outcome_.value)) return;
  outcome_.value = value;
  outcome_.best = x;
  if (outcome_.evaluations > 1) ++outcome_.successes;
  if (value <= limits_.reach) ending_ = Ending::target_reached;
  outcome_.history.push_back(
      {outcome_.successes, outcome_.iterations, outcome_.evaluations, 1, move, outcome_.best, value});
  if (limits_.progress && !limits_.progress(outcome_.history.back()) && !ending_) ending_ = Ending::stopped;
}

Outcome Tally::finish(Ending by_itself, std::string why) {
  outcome_.ending = ending_.value_or(by_itself);
  if (!found() && outcome_.ending != Ending::stopped) outcome_.ending = Ending::no_start;
  outcome_.sentence = sentence(std::move(why));
  return std::move(outcome_);
}

std::string Tally::sentence(std::string why) const {
  switch (outcome_.ending) {
    case Ending::evaluation_limit:
      return fmt::format("stopped by the limit of {} evaluations", limits_.most_evaluations);
    case Ending::target_reached:
      return fmt::format("reached {:.4g}, at or below the {:.4g} asked for", outcome_.value, limits_.reach);
    case Ending::stopped:
      return "stopped on request";
    case Ending::no_start:
      return fmt::format("not started: none of {} points tried has a finite value", outcome_.evaluations);
    case Ending::converged:
      return "converged: " + (free_.empty() ? "no variable can move" : std::move(why));
    case Ending::iteration_limit:
    case Ending::failed:
      break;
  }
  return why;
}

}  // namespace catoptric::optim
