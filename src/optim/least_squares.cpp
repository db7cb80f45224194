#include "optim/least_squares.h"

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>

#include "base/errors.h"

namespace catoptric::optim {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The last point evaluated: Ceres asks for some of them twice.
struct LastPoint {
  std::vector<double> x, residuals, jacobian;
  bool known = false, has_jacobian = false, built = false;
};

/// The problem with what the search must keep count of. Everything that ends the search is remembered here,
/// since Ceres knows a failed evaluation only, and no exception may pass through it.
class Ledger {
 public:
  Ledger(const LeastSquaresProblem& problem, const LevenbergMarquardtOptions& options);

  std::vector<std::size_t> free;  ///< variables that may move now; Ceres knows no others
  Outcome outcome{};
  std::optional<Ending> ending;
  std::exception_ptr failure;

  /// Ceres' unit of the residuals: a power of two near their norm at the start.
  double residual_unit() const {
    const double norm = outcome.start_value;
    return norm > 0 && norm < infinity ? std::exp2(std::ilogb(norm)) : 1.0;
  }
  double unit(std::size_t i) const { return natural_unit(problem_.variables[free[i]]); }

  /// The point at the free values given, in natural units; null when the search has to end or the point
  /// cannot be built.
  const LastPoint* at(const double* free_values, bool with_jacobian);
  void record(const char* move, double radius);

  bool on_bound() const;  ///< whether the best point has a free variable there
  /// Takes what the best point has on a bound out of the free variables. False when that was nothing.
  bool hold_at_bounds();
  /// Frees what is held although the residuals would fall further inside. False when that is nothing.
  bool release_pulled_back();
  bool over() const { return ending || failure; }

 private:
  bool at_bound(std::size_t i) const;
  bool may_evaluate();
  void evaluate(bool with_jacobian);
  void keep_best();

  const LeastSquaresProblem& problem_;
  const LevenbergMarquardtOptions& options_;
  LastPoint last_;
};

Ledger::Ledger(const LeastSquaresProblem& problem, const LevenbergMarquardtOptions& options)
    : problem_(problem), options_(options) {
  for (const Variable& variable : problem.variables) outcome.best.push_back(variable.start);
  outcome.value = outcome.start_value = infinity;
  last_.x = outcome.best;
  last_.residuals.resize(problem.residual_count);
  last_.jacobian.resize(problem.residual_count * last_.x.size());
  for (std::size_t i = 0; i < problem.variables.size(); ++i)
    if (problem.variables[i].lower < problem.variables[i].upper) free.push_back(i);
}

bool Ledger::at_bound(std::size_t i) const {
  return outcome.best[i] == problem_.variables[i].lower || outcome.best[i] == problem_.variables[i].upper;
}

bool Ledger::on_bound() const {
  return std::ranges::any_of(free, [this](std::size_t i) { return at_bound(i); });
}

bool Ledger::hold_at_bounds() {
  return std::erase_if(free, [this](std::size_t i) { return at_bound(i); }) > 0;
}

bool Ledger::release_pulled_back() {
  constexpr double least_cosine = 1e-8;  // of residuals and derivatives: rounding, seen from there
  std::vector<double> values;
  for (std::size_t i = 0; i < free.size(); ++i) values.push_back(outcome.best[free[i]] / unit(i));
  const LastPoint* point = at(values.data(), true);
  if (!point) return false;
  const std::size_t before = free.size(), columns = point->x.size();
  for (std::size_t i = 0; i < columns; ++i) {
    const Variable& variable = problem_.variables[i];
    if (!(variable.lower < variable.upper) || std::ranges::find(free, i) != free.end()) continue;
    double gradient = 0, square = 0;
    for (std::size_t row = 0; row < problem_.residual_count; ++row) {
      const double derivative = point->jacobian[row * columns + i];
      gradient += derivative * point->residuals[row];
      square += derivative * derivative;
    }
    const double inwards = outcome.best[i] == variable.lower ? -gradient : gradient;
    if (inwards > least_cosine * std::sqrt(square) * outcome.value) free.push_back(i);
  }
  std::ranges::sort(free);
  return free.size() > before;
}

bool Ledger::may_evaluate() {
  if (over()) return false;
  if (outcome.evaluations >= options_.most_evaluations)
    ending = Ending::evaluation_limit;
  else if (options_.stop_requested && options_.stop_requested())
    ending = Ending::stopped;
  return !ending;
}

const LastPoint* Ledger::at(const double* free_values, bool with_jacobian) {
  std::vector<double> x = outcome.best;  // what is held stands there
  for (std::size_t i = 0; i < free.size(); ++i) {
    const Variable& variable = problem_.variables[free[i]];
    x[free[i]] = std::clamp(free_values[i] * unit(i), variable.lower, variable.upper);
  }
  const bool same = last_.known && x == last_.x;
  last_.x = std::move(x);
  if (same && (last_.has_jacobian || !with_jacobian || !last_.built)) return last_.built ? &last_ : nullptr;
  last_.known = false;
  try {
    if (!may_evaluate()) return nullptr;
    evaluate(with_jacobian);
  } catch (...) {
    failure = std::current_exception();
    return nullptr;
  }
  return last_.built ? &last_ : nullptr;
}

void Ledger::evaluate(bool with_jacobian) {
  const auto finite = [](double value) { return std::isfinite(value); };
  last_.built =
      problem_.evaluate(last_.x, last_.residuals, with_jacobian ? last_.jacobian.data() : nullptr) &&
      std::ranges::all_of(last_.residuals, finite) &&
      (!with_jacobian || std::ranges::all_of(last_.jacobian, finite));
  last_.known = true;
  last_.has_jacobian = with_jacobian;
  ++outcome.evaluations;
  if (last_.built) keep_best();
}

void Ledger::keep_best() {
  double sum = 0;
  for (const double residual : last_.residuals) sum += residual * residual;
  const double value = std::sqrt(sum);
  if (outcome.start_value == infinity) outcome.start_value = value;
  if (!(value < outcome.value)) return;
  outcome.value = value;
  outcome.best = last_.x;
  if (value <= options_.reach) ending = Ending::target_reached;
}

void Ledger::record(const char* move, double radius) {
  outcome.history.push_back({outcome.successes, outcome.iterations, outcome.evaluations,
                             radius / options_.first_trust_radius, move, outcome.best, outcome.value});
  if (options_.progress && !options_.progress(outcome.history.back()) && !ending) ending = Ending::stopped;
}

/// All residuals as one block of Ceres.
class Residuals : public ceres::CostFunction {
 public:
  Residuals(Ledger& ledger, std::size_t count) : ledger_(ledger) {
    set_num_residuals(static_cast<int>(count));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(ledger.free.size()));
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const bool with_jacobian = jacobians && jacobians[0];
    const LastPoint* point = ledger_.at(blocks[0], with_jacobian);
    if (!point) return false;
    const double scale = 1 / ledger_.residual_unit();
    for (const double residual : point->residuals) *residuals++ = scale * residual;
    if (!with_jacobian) return true;
    const std::size_t columns = point->x.size();
    double* out = jacobians[0];
    for (std::size_t row = 0; row < point->residuals.size(); ++row)
      for (std::size_t i = 0; i < ledger_.free.size(); ++i)
        *out++ = scale * ledger_.unit(i) * point->jacobian[row * columns + ledger_.free[i]];
    return true;
  }

 private:
  Ledger& ledger_;
};

class Watcher : public ceres::IterationCallback {
 public:
  explicit Watcher(Ledger& ledger) : ledger_(ledger) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const bool begins = summary.iteration == 0;
    if (!begins) {
      ++ledger_.outcome.iterations;
      if (summary.step_is_successful) ++ledger_.outcome.successes;
    }
    if (begins && !ledger_.outcome.history.empty()) return ceres::SOLVER_CONTINUE;  // a further round
    try {
      ledger_.record(begins                       ? "start"
                     : summary.step_is_successful ? "step"
                                                  : "reduce",
                     summary.trust_region_radius);
    } catch (...) {
      ledger_.failure = std::current_exception();
    }
    const bool round_over = summary.step_is_successful && !begins && ledger_.on_bound();
    return ledger_.over() || round_over ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  Ledger& ledger_;
};

ceres::Solver::Options solver_options(const LevenbergMarquardtOptions& options) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = static_cast<int>(options.most_iterations);
  solver.function_tolerance = options.value_tolerance;
  solver.gradient_tolerance = options.gradient_tolerance;
  solver.parameter_tolerance = options.step_tolerance;
  solver.initial_trust_region_radius = options.first_trust_radius;
  solver.max_num_consecutive_invalid_steps = 20;  // each takes the radius down by 2, then 4, 8, ...
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  return solver;
}

std::string sentence(const Outcome& outcome, const LevenbergMarquardtOptions& options,
                     const std::string& by_ceres, bool all_held) {
  switch (outcome.ending) {
    case Ending::evaluation_limit:
      return fmt::format("stopped by the limit of {} evaluations", options.most_evaluations);
    case Ending::iteration_limit:
      return fmt::format("stopped by the limit of {} iterations", options.most_iterations);
    case Ending::target_reached:
      return fmt::format("reached {:.4g}, at or below the {:.4g} asked for", outcome.value, options.reach);
    case Ending::stopped:
      return "stopped on request";
    case Ending::no_start:
      return "not started: the residuals have no finite value at the start";
    case Ending::converged:
      return all_held ? "converged: every variable is held by a bound" : "converged: " + by_ceres;
    case Ending::failed:
      return "gave up: " + by_ceres;
  }
  return {};
}

Ending ending_of(const Ledger& ledger, const ceres::Solver::Summary& summary) {
  if (ledger.ending) return *ledger.ending;
  if (ledger.outcome.value == infinity) return Ending::no_start;
  if (ledger.free.empty() || summary.termination_type == ceres::CONVERGENCE) return Ending::converged;
  if (summary.termination_type == ceres::NO_CONVERGENCE) return Ending::iteration_limit;
  return Ending::failed;
}

void require_sound(const LeastSquaresProblem& problem) {
  if (problem.residual_count == 0 || !problem.evaluate)
    throw InputError({"there is nothing to fit", "", "the problem has no residuals", "set them"});
  optim::require_sound({problem.variables, [](std::span<const double>) { return 0.0; }});
}

/// Ceres would write its warnings to standard error; what they say is in the outcome.
void silence_ceres() {
  static const bool once = (FLAGS_minloglevel = google::GLOG_FATAL, true);
  static_cast<void>(once);
}

/// One run of Ceres over the free variables, from the best point so far.
ceres::Solver::Summary solve(Ledger& ledger, const LeastSquaresProblem& problem,
                             const LevenbergMarquardtOptions& options) {
  std::vector<double> values;
  for (std::size_t i = 0; i < ledger.free.size(); ++i)
    values.push_back(ledger.outcome.best[ledger.free[i]] / ledger.unit(i));
  // Before Ceres asks: the residuals' unit follows from the start.
  if (ledger.outcome.evaluations == 0) ledger.at(values.data(), true);
  ceres::Problem model;
  model.AddResidualBlock(new Residuals(ledger, problem.residual_count), nullptr, values.data());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Variable& variable = problem.variables[ledger.free[i]];
    const int index = static_cast<int>(i);
    const double unit = ledger.unit(i);
    if (std::isfinite(variable.lower))
      model.SetParameterLowerBound(values.data(), index, variable.lower / unit);
    if (std::isfinite(variable.upper))
      model.SetParameterUpperBound(values.data(), index, variable.upper / unit);
  }
  Watcher watcher(ledger);
  ceres::Solver::Options solver = solver_options(options);
  solver.max_num_iterations = static_cast<int>(options.most_iterations - ledger.outcome.iterations);
  solver.callbacks.push_back(&watcher);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &model, &summary);
  return summary;
}

/// Ceres cuts a step off at the bounds and leaves what the other variables should do then undone. So what
/// comes to a bound is held there while the rest goes on, until the residuals pull it back: an active set.
ceres::Solver::Summary solve_in_rounds(Ledger& ledger, const LeastSquaresProblem& problem,
                                       const LevenbergMarquardtOptions& options) {
  ceres::Solver::Summary summary;
  double at_release = infinity;
  while (true) {
    if (!ledger.free.empty()) summary = solve(ledger, problem, options);
    if (ledger.over() || ledger.outcome.value == infinity) return summary;
    if (ledger.outcome.iterations >= options.most_iterations) break;
    if (ledger.hold_at_bounds()) continue;
    if (!(ledger.outcome.value < (1 - options.value_tolerance) * at_release)) return summary;
    at_release = ledger.outcome.value;
    if (!ledger.release_pulled_back()) return summary;
  }
  ledger.ending = Ending::iteration_limit;
  return summary;
}

}  // namespace

Outcome levenberg_marquardt(const LeastSquaresProblem& problem, const LevenbergMarquardtOptions& options) {
  require_sound(problem);
  silence_ceres();
  Ledger ledger(problem, options);
  if (ledger.free.empty()) ledger.at(nullptr, false);  // nothing can move: one value is the outcome
  const ceres::Solver::Summary summary = solve_in_rounds(ledger, problem, options);
  if (ledger.failure) std::rethrow_exception(ledger.failure);
  Outcome outcome = std::move(ledger.outcome);
  outcome.ending = ending_of(ledger, summary);
  outcome.sentence = sentence(outcome, options, summary.message, ledger.free.empty());
  return outcome;
}

}  // namespace catoptric::optim
