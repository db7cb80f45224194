#include "design/foresight.h"

#include <catch2/catch.hpp>
#include <set>

#include "base/errors.h"
#include "optim/hooke_jeeves.h"
#include "optim/nelder_mead.h"
#include "optim/pagmo_search.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

/// Ranks that are one process: counts how often they come together, and over how many tasks.
class CountedRanks : public Ranks {
 public:
  explicit CountedRanks(int size) : size_(size) {}
  int size() const override { return size_; }
  Bytes join(std::size_t count, const Compute& compute, const Take& take, const Joined& joined) override {
    ++joins;
    tasks += count;
    return Ranks::join(count, compute, take, joined);
  }
  std::size_t joins = 0, tasks = 0;

 private:
  int size_;
};

double rosenbrock(std::span<const double> x) {
  return 100 * (x[1] - x[0] * x[0]) * (x[1] - x[0] * x[0]) + (1 - x[0]) * (1 - x[0]);
}

optim::Problem valley() { return {{{"a", -1.2, 0.5, -3, 3}, {"b", 1, 0.5, -3, 3}}, rosenbrock}; }

using Search = std::function<optim::Outcome(const optim::Problem&, const optim::SearchLimits&)>;

/// The same search with its evaluations computed by ranks.
/// @out  asked: every point once that it asked for
optim::Outcome by_ranks(const Search& search, Ranks& ranks, const optim::SearchLimits& limits,
                        std::set<std::vector<double>>& asked) {
  std::atomic<bool> stopped = false;
  Foresight foresight(
      ranks, valley(),
      [&](const optim::Problem& guessed, const std::function<bool()>& enough) {
        optim::SearchLimits quiet = limits;
        quiet.stop_requested = enough;
        search(guessed, quiet);
      },
      nullptr, stopped);
  return search({valley().variables,
                 [&](std::span<const double> x) {
                   asked.emplace(x.begin(), x.end());
                   return foresight.evaluate(x);
                 }},
                limits);
}

void require_same(const optim::Outcome& a, const optim::Outcome& b) {
  CHECK(a.best == b.best);
  CHECK(a.value == b.value);
  CHECK(a.evaluations == b.evaluations);
  CHECK(a.cache_hits == b.cache_hits);
  CHECK(a.sentence == b.sentence);
  REQUIRE(a.history.size() == b.history.size());
  for (std::size_t i = 0; i < a.history.size(); ++i) CHECK(a.history[i].x == b.history[i].x);
}

Search pagmo(optim::PagmoMethod method) {
  return [method](const optim::Problem& problem, const optim::SearchLimits& limits) {
    return optim::pagmo_search(problem, method,
                               {.limits = limits, .seed = 5, .population = 12, .annealing_evaluations = 300});
  };
}

optim::Outcome pattern(const optim::Problem& problem, const optim::SearchLimits& limits) {
  optim::HookeJeevesOptions options;
  options.most_evaluations = limits.most_evaluations;
  options.stop_requested = limits.stop_requested;
  return optim::hooke_jeeves(problem, options);
}

}  // namespace

// Populations are computed by generations (12 here) with nothing in vain; what depends on each answer, by
// guesses.
TEST_CASE("a search with foresight is the same search and comes together less often than it evaluates") {
  using enum optim::PagmoMethod;
  struct Case {
    const char* name;
    Search search;
    double least_gain;     ///< evaluations over meetings with four ranks
    double most_vain = 1;  ///< share of what was computed that the search never asked for, with four ranks
  };
  const Case cases[] = {{"hooke-jeeves", pattern, 1.2, 0.6},
                        {"nelder-mead",
                         [](const auto& problem, const auto& limits) {
                           return optim::nelder_mead(problem, {.limits = limits});
                         },
                         1.0, 0.75},
                        {"cma-es", pagmo(cma_es), 10, 0.0},
                        {"differential-evolution", pagmo(differential_evolution), 10, 0.0},
                        {"particle-swarm", pagmo(particle_swarm), 2.0, 0.3},
                        {"genetic", pagmo(genetic), 10, 0.03},
                        {"compass", pagmo(compass), 1.2, 0.5},
                        {"simulated-annealing", pagmo(simulated_annealing), 1.0, 0.75}};
  for (const Case& each : cases) {
    INFO(each.name);
    optim::SearchLimits limits;
    limits.most_evaluations = 240;
    const optim::Outcome alone = each.search(valley(), limits);
    for (const int size : {2, 4}) {
      CountedRanks ranks(size);
      std::set<std::vector<double>> asked;
      require_same(by_ranks(each.search, ranks, limits, asked), alone);
      const double gain = static_cast<double>(alone.evaluations) / static_cast<double>(ranks.joins);
      const double vain = 1 - static_cast<double>(asked.size()) / static_cast<double>(ranks.tasks);
      CAPTURE(size, alone.evaluations, ranks.joins, ranks.tasks, gain, vain);
      CHECK(vain <= each.most_vain);
      if (size == 4) CHECK(gain >= each.least_gain);
    }
  }
}

TEST_CASE("an evaluation that was broken off on any rank stops the search on all") {
  CountedRanks ranks(2);
  std::atomic<bool> stopped = false;
  Foresight foresight(ranks,
                      {valley().variables, [](std::span<const double>) -> double { throw Interrupted(); }},
                      {}, nullptr, stopped);
  CHECK_THROWS_AS(foresight.evaluate(std::vector<double>{0, 0}), Interrupted);
  CHECK(stopped);
}
