#include "optim/hooke_jeeves.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "base/errors.h"
#include "base/random_stream.h"

using namespace catoptric;
using namespace catoptric::optim;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Point = std::vector<double>;

/// A problem that writes down every point it is asked for.
struct Recorded {
  std::vector<Point> asked;
  Problem problem;

  Recorded(std::vector<Variable> variables, std::function<double(const Point&)> f) {
    problem.variables = std::move(variables);
    problem.evaluate = [this, f = std::move(f)](std::span<const double> x) {
      asked.emplace_back(x.begin(), x.end());
      return f(asked.back());
    };
  }
  Recorded(const Recorded&) = delete;
};

std::vector<Variable> free_variables(const Point& start, double step) {
  std::vector<Variable> variables;
  for (double x : start)
    variables.push_back({"x" + std::to_string(variables.size()), x, step, -infinity, infinity});
  return variables;
}

double bowl(const Point& x) {
  double sum = 0;
  for (double each : x) sum += each * each;
  return sum;
}

double rosenbrock(const Point& x) { return 100 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1 - x[0], 2); }

std::vector<std::string> moves(const Outcome& outcome) {
  std::vector<std::string> names;
  for (const Iterate& iterate : outcome.history) names.push_back(iterate.move);
  return names;
}

}  // namespace

TEST_CASE("every evaluation on x^2 + y^2 is the one the paper's rules give by hand") {
  Recorded recorded(free_variables({3, 2}, 1), bowl);
  HookeJeevesOptions options;
  options.smallest_step = 0.4;  // ends after two halvings
  const Outcome outcome = hooke_jeeves(recorded.problem, options);
  const std::vector<Point> by_hand = {
      {3, 2},                               // start, f = 13
      {4, 2},   {2, 2},   {2, 3},  {2, 1},  // explore: no, yes (8), no, yes (5): x_1 = (2, 1)
      {1, 0},   {2, 0},   {0, 0},  {0, 1},  // pattern point (f = 1); no, yes (0), no,
      {0, -1},                              //   no: x_2 = (0, 0)
      {-2, -1}, {-1, -1}, {-1, 0},          // pattern point, worse (5) but tried: yes (2), yes (1): not < 0
                                            // explore x_2: (1, 0); the other three are known; reduce to 1/2
      // x_2 did not move, so there is no direction: explore x_2 with half the step, reduce to 1/4
  };
  std::vector<Point> expected = by_hand;
  expected.insert(expected.end(), {{0.5, 0}, {-0.5, 0}, {0, 0.5}, {0, -0.5}});
  // (1, 0) was the pattern point of iteration 2 and is known, too
  CHECK(recorded.asked == expected);
  CHECK(moves(outcome) == std::vector<std::string>{"start", "exploratory", "pattern", "reduce", "reduce"});
  CHECK(outcome.best == Point{0, 0});
  CHECK(outcome.value == 0);
  CHECK(outcome.start_value == 13);
  CHECK(outcome.ending == Ending::converged);
  CHECK(outcome.successes == 2);
  CHECK(outcome.iterations == 4);
  CHECK(outcome.evaluations == 17);
  CHECK(outcome.cache_hits == 4);
  CHECK(outcome.history.back().step == 0.25);
  CHECK(outcome.history[1].evaluations == 5);
  CHECK(outcome.history[2].x == Point{0, 0});
}

TEST_CASE("with the pattern kept, a failed iteration tries the last direction again") {
  Recorded recorded(free_variables({3, 2}, 1), bowl);
  HookeJeevesOptions options;
  options.smallest_step = 0.4;
  options.pattern_after_failure = PatternAfterFailure::kept;
  const Outcome outcome = hooke_jeeves(recorded.problem, options);
  // iteration 4 by hand: pattern point (-2, -1) is known (5); its half-step neighbours
  const std::vector<Point> fourth = {{-1.5, -1}, {-1.5, -0.5}, {0.5, 0}, {-0.5, 0}, {0, 0.5}, {0, -0.5}};
  REQUIRE(recorded.asked.size() == 13 + fourth.size());
  CHECK(std::vector<Point>(recorded.asked.begin() + 13, recorded.asked.end()) == fourth);
  CHECK(outcome.best == Point{0, 0});
}

TEST_CASE("the acceleration stretches the pattern step") {
  for (double acceleration : {0.5, 1.0, 2.0}) {
    Recorded recorded(free_variables({100}, 1), bowl);
    HookeJeevesOptions options;
    options.acceleration = acceleration;
    options.most_evaluations = 4;
    hooke_jeeves(recorded.problem, options);
    CHECK(recorded.asked[3] == Point{99 - acceleration});  // after 100, 101, 99
  }
}

TEST_CASE("without acceleration no pattern point is tried") {
  Recorded recorded(free_variables({3, 2}, 1), bowl);
  HookeJeevesOptions options;
  options.acceleration = 0;
  const Outcome outcome = hooke_jeeves(recorded.problem, options);
  for (const Iterate& iterate : outcome.history) CHECK(iterate.move != "pattern");
  CHECK(outcome.value == 0);
}

namespace {

/// The rules of section 4.5 once more, straight from the text: no cache, no bounds, no limits. With
/// `minus_first` it breaks the rule of eqs. 9 and 10 on purpose.
struct PlainSearch {
  std::function<double(const Point&)> f;
  Point step;
  bool minus_first = false;

  Point explore(Point trial, double share) const {
    for (std::size_t i = 0; i < trial.size(); ++i)
      for (double sign : {1.0, -1.0}) {
        Point moved = trial;
        moved[i] += (minus_first ? -sign : sign) * share * step[i];
        if (f(moved) < f(trial)) {
          trial = moved;
          break;
        }
      }
    return trial;
  }

  std::vector<Point> iterates(const Point& start, double acceleration, double smallest) const {
    std::vector<Point> sequence{start};
    bool direction = false;
    for (double share = 1; share >= smallest;) {
      const Point now = sequence.back();
      Point next = now;
      if (direction) {
        Point a = now;
        const Point& before = sequence[sequence.size() - 2];
        for (std::size_t i = 0; i < a.size(); ++i) a[i] += acceleration * (now[i] - before[i]);
        next = explore(a, share);
      }
      if (!(f(next) < f(now))) next = explore(now, share);
      direction = f(next) < f(now);
      if (direction)
        sequence.push_back(next);
      else
        share /= 2;
    }
    return sequence;
  }
};

std::vector<Point> improving_sequence(const Outcome& outcome) {
  std::vector<Point> sequence;
  for (const Iterate& iterate : outcome.history)
    if (iterate.move != "reduce") sequence.push_back(iterate.x);
  return sequence;
}

}  // namespace

TEST_CASE("the ever-improving sequence equals that of a plain search without cache") {
  HookeJeevesOptions options;
  options.smallest_step = 1e-6;  // the search's own knob, not a tolerance
  options.most_iterations = options.most_evaluations = 1000000;
  const auto steep = [](const Point& x) {
    return std::abs(x[0] - x[1]) + 0.1 * bowl(x) + std::sin(3 * x[0]);
  };
  const std::vector<std::function<double(const Point&)>> functions = {rosenbrock, bowl, steep};
  for (const auto& f : functions)
    for (double acceleration : {0.5, 1.0, 2.0}) {
      Recorded recorded(free_variables({-1.2, 1}, 0.3), f);
      options.acceleration = acceleration;
      const Outcome outcome = hooke_jeeves(recorded.problem, options);
      const PlainSearch plain{f, {0.3, 0.3}};
      CHECK(improving_sequence(outcome) == plain.iterates({-1.2, 1}, acceleration, options.smallest_step));
    }
  // on a ridge both neighbours are better, and then the order of eqs. 9 and 10 shows
  const auto ridge = [](const Point& x) { return -std::abs(x[0]) + 0.1 * bowl(x); };
  Recorded recorded(free_variables({0, 1}, 0.3), ridge);
  const PlainSearch right{ridge, {0.3, 0.3}}, wrong{ridge, {0.3, 0.3}, true};
  options.acceleration = 1;
  const auto sequence = improving_sequence(hooke_jeeves(recorded.problem, options));
  CHECK(sequence == right.iterates({0, 1}, 1, options.smallest_step));
  CHECK_FALSE(sequence == wrong.iterates({0, 1}, 1, options.smallest_step));
}

TEST_CASE("Rosenbrock's valley is followed to its end") {
  Recorded recorded(free_variables({-1.2, 1}, 0.5), rosenbrock);
  HookeJeevesOptions options;
  options.smallest_step = 1e-9;
  const Outcome outcome = hooke_jeeves(recorded.problem, options);
  CHECK(outcome.ending == Ending::converged);
  // The last lattice step is 5e-10; along the valley curvature is 0.4, across it 1000, so a point none of
  // whose neighbours is better lies within about 1000 / 0.4 steps.
  CHECK(outcome.best[0] == Approx(1).margin(2e-6));
  CHECK(outcome.best[1] == Approx(1).margin(4e-6));
}

TEST_CASE("no point is evaluated twice, and what is counted is what happened") {
  Recorded recorded(free_variables({-1.2, 1}, 0.25), rosenbrock);
  const Outcome outcome = hooke_jeeves(recorded.problem, {});
  const std::set<Point> distinct(recorded.asked.begin(), recorded.asked.end());
  CHECK(distinct.size() == recorded.asked.size());
  CHECK(outcome.evaluations == static_cast<long>(recorded.asked.size()));
  CHECK(outcome.cache_hits > 0);
}

TEST_CASE("the history is complete and only ever improves") {
  Recorded recorded(free_variables({-1.2, 1}, 0.25), rosenbrock);
  const Outcome outcome = hooke_jeeves(recorded.problem, {});
  long reductions = 0;
  for (std::size_t i = 1; i < outcome.history.size(); ++i) {
    const Iterate& before = outcome.history[i - 1];
    const Iterate& now = outcome.history[i];
    CHECK(now.iteration == before.iteration + 1);
    CHECK(now.evaluations >= before.evaluations);
    CHECK(now.value == rosenbrock(now.x));
    if (now.move == "reduce") {
      ++reductions;
      CHECK(now.k == before.k);
      CHECK(now.x == before.x);
      CHECK(now.step == before.step / 2);
    } else {
      CHECK(now.k == before.k + 1);
      CHECK(now.value < before.value);
      CHECK(now.step == before.step);
    }
  }
  CHECK(reductions == 10);  // 2^-10 is the first power of two below 1e-3: Table 2's iterations - k
  CHECK(outcome.iterations == outcome.successes + reductions);
  CHECK(outcome.history.back().x == outcome.best);
}

TEST_CASE("equal searches give equal histories") {
  Recorded first(free_variables({-1.2, 1}, 0.25), rosenbrock),
      second(free_variables({-1.2, 1}, 0.25), rosenbrock);
  const Outcome a = hooke_jeeves(first.problem, {}), b = hooke_jeeves(second.problem, {});
  CHECK(first.asked == second.asked);
  CHECK(a.sentence == b.sentence);
  CHECK(improving_sequence(a) == improving_sequence(b));
}
