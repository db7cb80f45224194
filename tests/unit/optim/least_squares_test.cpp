#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "base/errors.h"
#include "optim/least_squares.h"

using namespace catoptric;
using namespace catoptric::optim;

namespace {

using Point = std::vector<double>;

/// Rosenbrock's function as residuals 10 (y - x^2) and 1 - x: the norm is 0 at (1, 1).
LeastSquaresProblem rosenbrock(Variable x, Variable y) {
  return {{std::move(x), std::move(y)},
          2,
          [](std::span<const double> at, std::span<double> residuals, double* jacobian) {
            residuals[0] = 10 * (at[1] - at[0] * at[0]);
            residuals[1] = 1 - at[0];
            if (!jacobian) return true;
            jacobian[0] = -20 * at[0];
            jacobian[1] = 10;
            jacobian[2] = -1;
            jacobian[3] = 0;
            return true;
          }};
}

}  // namespace

TEST_CASE("Levenberg-Marquardt follows Rosenbrock's valley to its end") {
  const Outcome outcome = levenberg_marquardt(rosenbrock({"x", -1.2, 1, -9, 9}, {"y", 1, 1, -9, 9}), {});
  CHECK(outcome.ending == Ending::converged);
  CHECK(outcome.best[0] == Approx(1).epsilon(1e-9));
  CHECK(outcome.best[1] == Approx(1).epsilon(1e-9));
  CHECK(outcome.value < 1e-8);
  CHECK(outcome.start_value == Approx(std::sqrt(24.2)));  // f = 24.2 there, Rosenbrock 1960
  CHECK(outcome.evaluations < 60);
  CHECK(outcome.history.front().move == "start");
  CHECK(outcome.history.back().value == outcome.value);
  CHECK(outcome.iterations >= outcome.successes);
}

TEST_CASE("Levenberg-Marquardt ends on the bound that holds it, and asks for nothing beyond") {
  long outside = 0;
  LeastSquaresProblem problem = rosenbrock({"x", -1.2, 1, -2, 0.5}, {"y", 1, 1, -9, 9});
  problem.evaluate = [&, inner = problem.evaluate](std::span<const double> x, std::span<double> r,
                                                   double* jacobian) {
    outside += x[0] < -2 || x[0] > 0.5;
    return inner(x, r, jacobian);
  };
  const Outcome outcome = levenberg_marquardt(problem, {});
  CHECK(outside == 0);
  CHECK(outcome.best[0] == 0.5);  // by hand: y = x^2 leaves (1 - x)^2, least at the bound
  CHECK(outcome.best[1] == Approx(0.25).epsilon(1e-7));
  CHECK(outcome.value == Approx(0.5));
  CHECK(outcome.evaluations < 60);  // Ceres by itself takes 130 and stops at 0.5006
}

TEST_CASE("Levenberg-Marquardt comes back from a bound that it overshot to") {
  // by hand: from 8 the first step is -37 atan(6) = -52, and at the bound 0 atan is less far off
  const LeastSquaresProblem problem{{{"x", 8, 1, 0, 9}, {"y", 5, 1, -9, 9}},
                                    2,
                                    [](std::span<const double> at, std::span<double> r, double* jacobian) {
                                      r[0] = std::atan(at[0] - 2);
                                      r[1] = at[1] - 2;
                                      if (!jacobian) return true;
                                      jacobian[0] = 1 / (1 + (at[0] - 2) * (at[0] - 2));
                                      jacobian[1] = jacobian[2] = 0;
                                      jacobian[3] = 1;
                                      return true;
                                    }};
  const Outcome outcome = levenberg_marquardt(problem, {});
  CHECK(std::ranges::any_of(outcome.history, [](const Iterate& each) { return each.x[0] == 0; }));
  CHECK(outcome.best[0] == Approx(2).epsilon(1e-9));
  CHECK(outcome.best[1] == Approx(2).epsilon(1e-9));
  CHECK(outcome.ending == Ending::converged);
}

TEST_CASE("a variable without room and one without bounds are both fine for Levenberg-Marquardt") {
  const double infinity = std::numeric_limits<double>::infinity();
  const Outcome fixed = levenberg_marquardt(rosenbrock({"x", 0.5, 1, 0.5, 0.5}, {"y", 1, 1, -9, 9}), {});
  CHECK(fixed.best[0] == 0.5);
  CHECK(fixed.best[1] == Approx(0.25).epsilon(1e-9));
  const Outcome both = levenberg_marquardt(rosenbrock({"x", 2, 1, 2, 2}, {"y", 1, 1, 1, 1}), {});
  CHECK(both.value == Approx(std::hypot(30, 1)));  // by hand: 10 (1 - 4) and 1 - 2
  const Outcome open = levenberg_marquardt(
      rosenbrock({"x", -1.2, 1, -infinity, infinity}, {"y", 1, 1, -infinity, infinity}), {});
  CHECK(open.value < 1e-8);
}

TEST_CASE("Levenberg-Marquardt walks around what cannot be built") {
  LeastSquaresProblem problem = rosenbrock({"x", -1.2, 1, -9, 9}, {"y", 1, 1, -9, 9});
  const auto inner = problem.evaluate;
  for (const bool as_number : {false, true}) {  // refused, or left not a number
    problem.evaluate = [&](std::span<const double> x, std::span<double> r, double* jacobian) {
      inner(x, r, jacobian);
      if (x[1] > -1.5) return true;  // the first full step from the start goes to y = -3.8
      r[0] = std::numeric_limits<double>::quiet_NaN();
      return as_number;
    };
    const Outcome outcome = levenberg_marquardt(problem, {});
    CHECK(outcome.value < 1e-8);
  }
  problem.evaluate = [&](std::span<const double>, std::span<double>, double*) { return false; };
  const Outcome none = levenberg_marquardt(problem, {});
  CHECK(none.ending == Ending::no_start);
  CHECK(none.best == Point{-1.2, 1});
  CHECK(std::isinf(none.value));
}

TEST_CASE("Levenberg-Marquardt counts its evaluations and keeps to its limits") {
  long calls = 0;
  LeastSquaresProblem problem = rosenbrock({"x", -1.2, 1, -9, 9}, {"y", 1, 1, -9, 9});
  problem.evaluate = [&, inner = problem.evaluate](std::span<const double> x, std::span<double> r,
                                                   double* jacobian) {
    ++calls;
    return inner(x, r, jacobian);
  };
  const Outcome whole = levenberg_marquardt(problem, {});
  CHECK(whole.evaluations == calls);
  for (long most = 1; most < whole.evaluations; ++most) {
    calls = 0;
    LevenbergMarquardtOptions options;
    options.most_evaluations = most;
    const Outcome outcome = levenberg_marquardt(problem, options);
    CHECK(calls == most);
    CHECK(outcome.evaluations == most);
    CHECK(outcome.ending == Ending::evaluation_limit);
    CHECK(outcome.value <= outcome.start_value);
  }
  LevenbergMarquardtOptions options;
  options.most_iterations = 2;
  CHECK(levenberg_marquardt(problem, options).ending == Ending::iteration_limit);
  options = {};
  options.reach = 1;
  const Outcome near = levenberg_marquardt(problem, options);
  CHECK(near.ending == Ending::target_reached);
  CHECK(near.value <= 1);
  options = {};
  options.progress = [](const Iterate& iterate) { return iterate.iteration < 3; };
  const Outcome watched = levenberg_marquardt(problem, options);
  CHECK(watched.ending == Ending::stopped);
  CHECK(watched.iterations == 3);
  options = {};
  options.stop_requested = [&] { return true; };
  calls = 0;
  CHECK(levenberg_marquardt(problem, options).ending == Ending::stopped);
  CHECK(calls == 0);
}

TEST_CASE("Levenberg-Marquardt gives the same bits every run") {
  const LeastSquaresProblem problem = rosenbrock({"x", -1.2, 1, -9, 9}, {"y", 1, 1, -9, 9});
  const Outcome first = levenberg_marquardt(problem, {}), again = levenberg_marquardt(problem, {});
  CHECK(first.best == again.best);
  CHECK(first.value == again.value);
  CHECK(first.evaluations == again.evaluations);
}

TEST_CASE("what the residuals throw comes through Levenberg-Marquardt, and nothing to fit is refused") {
  LeastSquaresProblem problem = rosenbrock({"x", -1.2, 1, -9, 9}, {"y", 1, 1, -9, 9});
  problem.evaluate = [](std::span<const double>, std::span<double>, double*) -> bool {
    throw std::runtime_error("lamp broken");
  };
  CHECK_THROWS_WITH(levenberg_marquardt(problem, {}), "lamp broken");
  problem.residual_count = 0;
  CHECK_THROWS_AS(levenberg_marquardt(problem, {}), InputError);
}
