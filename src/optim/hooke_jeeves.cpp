#include "optim/hooke_jeeves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors.h"
#include "base/float_traps.h"
#include "optim/cached_objective.h"

namespace catoptric::optim {
namespace {

struct Trial {
  std::vector<double> x;
  double value;
};

void require_option(bool sound, std::string_view name, double value, std::string_view rule) {
  if (sound) return;
  throw InputError({fmt::format("{} cannot be {}", name, value), "Hooke-Jeeves search", std::string(rule),
                    "leave it out to use the default"});
}

void require_sound(const HookeJeevesOptions& options) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  require_option(options.acceleration >= 0 && std::isfinite(options.acceleration), "acceleration",
                 options.acceleration, "it must be 0 or more and finite");
  require_option(options.reduction > 0 && options.reduction < 1, "reduction", options.reduction,
                 "it must lie between 0 and 1, both excluded");
  require_option(options.smallest_step > 0, "smallest_step", options.smallest_step, "it must be above 0");
  require_option(options.most_evaluations >= 1, "most_evaluations",
                 static_cast<double>(options.most_evaluations), "it must be 1 or more");
  require_option(options.most_iterations >= 0, "most_iterations",
                 static_cast<double>(options.most_iterations), "it must be 0 or more");
}

class Search {
 public:
  Search(const Problem& problem, const HookeJeevesOptions& options)
      : problem_(problem), options_(options), objective_(problem) {}

  Outcome run();

 private:
  bool evaluate_start();
  void iterate();
  bool improve_from(std::vector<double> x, std::string_view move);
  std::optional<double> value_at(const std::vector<double>& x);
  std::optional<Trial> temporarily_accepted(std::vector<double> x);
  void explore_around(Trial& trial);
  bool try_move(Trial& trial, std::size_t coordinate, double shift);
  std::optional<std::vector<double>> pattern_point() const;
  double moved(std::size_t coordinate, double from, double shift) const;
  void record(std::string_view move);
  void end(Ending ending) {
    if (!ending_) ending_ = ending;
  }
  std::string sentence() const;

  const Problem& problem_;
  const HookeJeevesOptions& options_;
  CachedObjective objective_;
  Trial best_;                                   // x_k
  std::optional<std::vector<double>> previous_;  // x_{k-1} while it gives a direction
  double share_ = 1;
  std::optional<Ending> ending_;
  Outcome outcome_{};
};

Outcome Search::run() {
  if (evaluate_start()) {
    record("start");
    while (!ending_) {
      if (share_ < options_.smallest_step)
        end(Ending::converged);
      else if (outcome_.iterations >= options_.most_iterations)
        end(Ending::iteration_limit);
      else
        iterate();
    }
  }
  outcome_.ending = *ending_;
  outcome_.sentence = sentence();
  outcome_.best = best_.x;
  outcome_.value = best_.value;
  outcome_.evaluations = objective_.evaluations();
  outcome_.cache_hits = objective_.cache_hits();
  return std::move(outcome_);
}

bool Search::evaluate_start() {
  for (const Variable& variable : problem_.variables) best_.x.push_back(variable.start);
  best_.value = objective_.compute(best_.x);
  outcome_.start_value = best_.value;
  if (std::isfinite(best_.value)) {
    if (best_.value <= options_.reach) end(Ending::target_reached);
    return true;
  }
  end(Ending::no_start);
  return false;
}

/// One attempt to find x_{k+1}: pattern step, then exploratory step, then reduction.
void Search::iterate() {
  ++outcome_.iterations;
  const auto pattern = pattern_point();
  if (pattern && improve_from(*pattern, "pattern")) return;
  if (!ending_ && improve_from(best_.x, "exploratory")) return;
  if (ending_) return;
  share_ *= options_.reduction;
  if (options_.pattern_after_failure == PatternAfterFailure::dropped) previous_.reset();
  record("reduce");
}

/// Coordinate search around x, which is accepted for the time being whatever its value; the result becomes
/// x_{k+1} only if it is better than x_k.
bool Search::improve_from(std::vector<double> x, std::string_view move) {
  auto trial = temporarily_accepted(std::move(x));
  if (!trial) return false;
  explore_around(*trial);
  if (!(trial->value < best_.value)) return false;
  previous_ = std::move(best_.x);
  best_ = std::move(*trial);
  ++outcome_.successes;
  if (best_.value <= options_.reach) end(Ending::target_reached);
  record(move);
  return true;
}

std::optional<Trial> Search::temporarily_accepted(std::vector<double> x) {
  if (x == best_.x) return best_;
  const auto value = value_at(x);
  if (!value) return {};
  return Trial{std::move(x), *value};
}

/// Paper section 4.5.1. Stops early, with `trial` the best it saw, when the search has to end.
void Search::explore_around(Trial& trial) {
  for (std::size_t i = 0; i < trial.x.size() && !ending_; ++i) {
    const double step = share_ * problem_.variables[i].step;
    if (try_move(trial, i, step)) continue;
    if (!ending_) try_move(trial, i, -step);
  }
}

bool Search::try_move(Trial& trial, std::size_t coordinate, double shift) {
  const double from = trial.x[coordinate];
  const double to = moved(coordinate, from, shift);
  if (to == from || !std::isfinite(to)) return false;
  trial.x[coordinate] = to;
  const auto value = value_at(trial.x);
  if (value && *value < trial.value) {
    trial.value = *value;
    return true;
  }
  trial.x[coordinate] = from;
  return false;
}

/// Remembered or computed; nothing when the search must end before computing it.
std::optional<double> Search::value_at(const std::vector<double>& x) {
  if (const auto known = objective_.recall(x)) return known;
  if (objective_.evaluations() >= options_.most_evaluations)
    end(Ending::evaluation_limit);
  else if (options_.stop_requested && options_.stop_requested())
    end(Ending::stopped);
  else
    return objective_.compute(x);
  return {};
}

/// a = x_k + alpha (x_k - x_{k-1}), clamped to the box; nothing when it is x_k itself.
std::optional<std::vector<double>> Search::pattern_point() const {
  if (!previous_) return {};
  std::vector<double> point = best_.x;
  for (std::size_t i = 0; i < point.size(); ++i) {
    point[i] = moved(i, best_.x[i], options_.acceleration * (best_.x[i] - (*previous_)[i]));
    if (!std::isfinite(point[i])) return {};
  }
  if (point == best_.x) return {};
  return point;
}

/// Within the bounds; infinite where there is none and the sum overflows, which is then no move.
double Search::moved(std::size_t coordinate, double from, double shift) const {
  const UntrappedFloats untrapped;
  const Variable& variable = problem_.variables[coordinate];
  return std::clamp(from + shift, variable.lower, variable.upper);
}

void Search::record(std::string_view move) {
  outcome_.history.push_back({outcome_.successes, outcome_.iterations, objective_.evaluations(), share_,
                              std::string(move), best_.x, best_.value});
  if (options_.progress && !options_.progress(outcome_.history.back())) end(Ending::stopped);
}

std::string Search::sentence() const {
  switch (*ending_) {
    case Ending::converged:
      return fmt::format("converged: the step fell below {} of its first size", options_.smallest_step);
    case Ending::evaluation_limit:
      return fmt::format("stopped by the limit of {} evaluations", options_.most_evaluations);
    case Ending::iteration_limit:
      return fmt::format("stopped by the limit of {} iterations", options_.most_iterations);
    case Ending::stopped:
      return "stopped on request";
    case Ending::no_start:
      return "not started: the objective has no finite value at the start";
    case Ending::target_reached:
      return fmt::format("reached {:.4g}, at or below the {:.4g} asked for", best_.value, options_.reach);
    case Ending::failed:
      break;  // this search cannot
  }
  return {};
}

}  // namespace

Outcome hooke_jeeves(const Problem& problem, const HookeJeevesOptions& options) {
  require_sound(problem);
  require_sound(options);
  return Search(problem, options).run();
}

}  // namespace catoptric::optim
