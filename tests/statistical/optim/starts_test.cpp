#include <catch2/catch.hpp>
#include <vector>

#include "optim/multi_start.h"
#include "support/statistics.h"

using namespace catoptric;
using namespace catoptric::optim;

namespace {

/// Where so many restarts begin in the box [-3, 5] x [10, 12], as shares of its sides.
std::vector<std::vector<double>> starts(StartPoints points, long restarts) {
  const Problem problem{{{"x", 0, 1, -3, 5}, {"y", 11, 1, 10, 12}},
                        [](std::span<const double>) { return 1.0; }};
  std::vector<std::vector<double>> list;
  multi_start(
      problem,
      [&](const StartedSearch& one) {
        list.push_back({(one.problem.variables[0].start + 3) / 8, (one.problem.variables[1].start - 10) / 2});
        Outcome outcome{};
        outcome.evaluations = 1;
        outcome.value = outcome.start_value = 1;
        return outcome;
      },
      {.limits = {.most_evaluations = 1'000'000}, .most_restarts = restarts, .points = points, .seed = 3});
  list.erase(list.begin());  // the problem's own start
  return list;
}

template <typename Bend>
double even_p(StartPoints points, const Bend& bend) {
  constexpr std::size_t bins = 8;
  std::vector<double> counts(bins * bins, 0);
  const auto bin = [](double share) { return std::min(bins - 1, static_cast<std::size_t>(share * bins)); };
  for (const auto& start : starts(points, 20'000)) counts[bins * bin(bend(start[0])) + bin(start[1])] += 1;
  return test::chi_square_even_p(counts);
}

}  // namespace

TEST_CASE("restarts begin evenly all over the box") {
  for (const StartPoints points : {StartPoints::random, StartPoints::sobol}) {
    CHECK(test::plausible(even_p(points, [](double share) { return share; })));
    CHECK(test::rejected(even_p(points, [](double share) { return share * share; })));  // wrong twin
  }
}
