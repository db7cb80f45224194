#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "base/errors.h"
#include "base/random_stream.h"
#include "optim/hooke_jeeves.h"

using namespace catoptric;
using namespace catoptric::optim;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
using Point = std::vector<double>;

Problem one_variable(Variable variable, std::function<double(double)> f) {
  return {{std::move(variable)}, [f = std::move(f)](std::span<const double> x) { return f(x[0]); }};
}

}  // namespace

TEST_CASE("a move across a bound is clamped to it and not repeated there") {
  std::vector<double> asked;
  const Problem problem = one_variable({"x", 0.5, 1, 0, 2}, [&](double x) {
    asked.push_back(x);
    return -x;
  });
  HookeJeevesOptions options;
  options.smallest_step = 0.6;
  const Outcome outcome = hooke_jeeves(problem, options);
  // by hand: explore 0.5 -> 1.5; the pattern point 2.5 is clamped to 2, where +1 is no move and -1 gives 1;
  // then the pattern point is 2 itself, so explore around it: +1 no move, 1 known; reduce, end
  CHECK(asked == std::vector<double>{0.5, 1.5, 2, 1});
  CHECK(outcome.best == Point{2});
  CHECK(outcome.ending == Ending::converged);
}

TEST_CASE("nothing outside the box is ever evaluated") {
  long outside = 0;
  Problem problem;
  problem.variables = {{"a", 0, 0.7, -0.3, 1.1}, {"b", 1, 0.9, 0.2, 1}, {"c", 4, 1, 4, 4}};
  problem.evaluate = [&](std::span<const double> x) {
    for (std::size_t i = 0; i < 3; ++i)
      outside += x[i] < problem.variables[i].lower || x[i] > problem.variables[i].upper;
    return std::pow(x[0] - 5, 2) + std::pow(x[1] + 5, 2) + x[2];
  };
  HookeJeevesOptions options;
  options.acceleration = 3;
  const Outcome outcome = hooke_jeeves(problem, options);
  CHECK(outside == 0);
  CHECK(outcome.best == Point{1.1, 0.2, 4});
}

TEST_CASE("a start without a value ends the search at once") {
  for (double value : {infinity, nan_value}) {
    long calls = 0;
    const Problem problem = one_variable({"x", 1, 1, -9, 9}, [&](double) {
      ++calls;
      return value;
    });
    const Outcome outcome = hooke_jeeves(problem, {});
    CHECK(outcome.ending == Ending::no_start);
    CHECK(outcome.value == infinity);
    CHECK(outcome.best == Point{1});
    CHECK(outcome.history.empty());
    CHECK(calls == 1);
  }
}

TEST_CASE("a hole in the domain is walked around, be it infinite or not a number") {
  for (double hole : {infinity, nan_value}) {
    // forbidden for 2 < x < 4: the pattern point at 3 has no value, but its neighbour at 4 does
    const Problem problem =
        one_variable({"x", 1, 1, -99, 99}, [&](double x) { return x > 2 && x < 4 ? hole : std::abs(x - 5); });
    const Outcome outcome = hooke_jeeves(problem, {});
    CHECK(outcome.best == Point{5});
    CHECK(outcome.value == 0);
  }
}

TEST_CASE("the evaluation limit is kept to the point, and what was gained stays") {
  const auto slope = [](double x) { return -x; };
  for (long limit : {1, 2, 3, 7, 50}) {
    long calls = 0;
    const Problem problem = one_variable({"x", 0, 1, -infinity, infinity}, [&](double x) {
      ++calls;
      return slope(x);
    });
    HookeJeevesOptions options;
    options.most_evaluations = limit;
    const Outcome outcome = hooke_jeeves(problem, options);
    CHECK(outcome.ending == Ending::evaluation_limit);
    CHECK(calls == limit);
    CHECK(outcome.evaluations == limit);
    CHECK(outcome.value == slope(outcome.best[0]));
    CHECK((limit == 1 || outcome.value < 0));
    CHECK(outcome.history.back().x == outcome.best);
  }
}

TEST_CASE("the iteration limit ends the search") {
  const Problem problem = one_variable({"x", 0, 1, -infinity, infinity}, [](double x) { return -x; });
  HookeJeevesOptions options;
  options.most_iterations = 3;
  const Outcome outcome = hooke_jeeves(problem, options);
  CHECK(outcome.ending == Ending::iteration_limit);
  CHECK(outcome.iterations == 3);
  options.most_iterations = 0;
  CHECK(hooke_jeeves(problem, options).best == Point{0});
}

TEST_CASE("the caller can stop after an iterate or before any evaluation") {
  const Problem problem = one_variable({"x", 0, 1, -infinity, infinity}, [](double x) { return -x; });
  HookeJeevesOptions options;
  options.progress = [](const Iterate& iterate) { return iterate.k < 2; };
  const Outcome after = hooke_jeeves(problem, options);
  CHECK(after.ending == Ending::stopped);
  CHECK(after.successes == 2);
  options.progress = nullptr;
  int asked = 0;
  options.stop_requested = [&] { return ++asked == 3; };
  const Outcome within = hooke_jeeves(problem, options);
  CHECK(within.ending == Ending::stopped);
  CHECK(within.evaluations == 3);
  CHECK(within.value < 0);
}

TEST_CASE("what cannot be searched is refused with the variable's name") {
  const auto f = [](double x) { return x; };
  const auto refused = [&](const Variable& variable) {
    try {
      hooke_jeeves(one_variable(variable, f), {});
    } catch (const InputError& error) {
      return error.parts().where.find("'w1'") != std::string::npos;
    }
    return false;
  };
  CHECK(refused({"w1", 1, 0, 0, 2}));
  CHECK(refused({"w1", 1, -1, 0, 2}));
  CHECK(refused({"w1", 1, nan_value, 0, 2}));
  CHECK(refused({"w1", 1, infinity, 0, 2}));
  CHECK(refused({"w1", 3, 1, 0, 2}));
  CHECK(refused({"w1", nan_value, 1, 0, 2}));
  CHECK(refused({"w1", infinity, 1, 0, infinity}));
  CHECK(refused({"w1", 1, 1, nan_value, 2}));
  CHECK(refused({"w1", 1, 1, 2, 0}));
  CHECK_FALSE(refused({"w1", 1, 1, 1, 1}));
  CHECK_THROWS_AS(hooke_jeeves({{}, [](std::span<const double>) { return 0.0; }}, {}), InputError);
  CHECK_THROWS_AS(hooke_jeeves({{{"x", 0, 1, 0, 1}}, nullptr}, {}), InputError);
}

TEST_CASE("options out of range are refused") {
  const Problem problem = one_variable({"x", 0, 1, -1, 1}, [](double x) { return x; });
  const auto refused = [&](auto change) {
    HookeJeevesOptions options;
    change(options);
    try {
      hooke_jeeves(problem, options);
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  for (double bad : {0.0, 1.0, -0.5, 2.0, nan_value})
    CHECK(refused([&](HookeJeevesOptions& o) { o.reduction = bad; }));
  for (double bad : {-1.0, infinity, nan_value})
    CHECK(refused([&](HookeJeevesOptions& o) { o.acceleration = bad; }));
  for (double bad : {0.0, -1.0, nan_value})
    CHECK(refused([&](HookeJeevesOptions& o) { o.smallest_step = bad; }));
  CHECK(refused([](HookeJeevesOptions& o) { o.most_evaluations = 0; }));
  CHECK(refused([](HookeJeevesOptions& o) { o.most_iterations = -1; }));
}

TEST_CASE("steps too small to change a number end the search instead of hanging it") {
  const Problem problem = one_variable({"x", 1e300, 1, -infinity, infinity}, [](double x) { return -x; });
  const Outcome outcome = hooke_jeeves(problem, {});
  CHECK(outcome.ending == Ending::converged);
  CHECK(outcome.evaluations == 1);
}

TEST_CASE("huge steps that overflow are no moves") {
  const double huge = std::numeric_limits<double>::max();
  const Problem problem = one_variable({"x", huge, huge, -infinity, infinity}, [](double x) { return -x; });
  const Outcome outcome = hooke_jeeves(problem, {});
  CHECK(std::isfinite(outcome.best[0]));
  CHECK(outcome.best[0] == huge);
}

TEST_CASE("a noisy, jumping function still ends no worse than it began") {
  const auto noisy = [](double x) {
    RandomStream stream(1, Purpose::test, static_cast<std::uint64_t>(std::llround(x * 1024) + 1000000));
    return std::floor(std::abs(x - 3)) + 0.3 * stream.uniform();
  };
  for (double start = -10; start <= 10; start += 0.5) {
    const Outcome outcome = hooke_jeeves(one_variable({"x", start, 1, -20, 20}, noisy), {});
    CHECK(outcome.ending == Ending::converged);
    CHECK(outcome.value <= noisy(start));
    // the noise (0.3) is smaller than a stair (1), so every stair is climbed down by steps of 1
    CHECK(outcome.value < 1);
  }
}

TEST_CASE("an objective that throws is not swallowed") {
  const Problem problem = one_variable({"x", 0, 1, -9, 9}, [](double x) -> double {
    if (x > 0) throw std::runtime_error("broken");
    return 0;
  });
  CHECK_THROWS_AS(hooke_jeeves(problem, {}), std::runtime_error);
}
