#include "optim/pagmo_search.h"

#include <algorithm>
#include <cmath>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/compass_search.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/algorithms/pso.hpp>
#include <pagmo/algorithms/sade.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/algorithms/simulated_annealing.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "base/float_traps.h"
#include "optim/tally.h"

namespace catoptric::optim {
namespace {

/// pagmo's view of the problem.
struct Objective {
  Tally* tally = nullptr;
  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    const TrappedFloats trapped;
    return {tally->evaluate(x)};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {tally->lower(), tally->upper()};
  }
};

bool from_one_point(PagmoMethod method) {
  return method == PagmoMethod::simulated_annealing || method == PagmoMethod::compass;
}

/// The warmest temperature: a step as bad as the values scatter over the box is then often taken.
double scatter(const std::vector<double>& values) {
  double mean = 0, square = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) square += (value - mean) * (value - mean);
  return values.size() > 1 ? std::sqrt(square / static_cast<double>(values.size() - 1)) : 0.0;
}

pagmo::algorithm annealing(Tally& tally, pagmo::population& population, long planned, unsigned seed) {
  constexpr int samples = 10;          // enough for the order of magnitude
  constexpr double far_above = 1e100;  // cannot be built
  // With these, 47 of 50 runs of 20000 evaluations find Rastrigin's least minimum in the plane.
  constexpr double coldest = 1e-4;  // over the warmest
  constexpr unsigned temperatures = 50, moves_per_range = 2;
  std::vector<double> values;
  for (int i = 0; i < samples; ++i) {
    const double value = tally.evaluate(population.random_decision_vector());
    if (value < far_above) values.push_back(value);
  }
  const double spread = scatter(values), warmest = spread > 0 ? spread : 1.0;
  const long moves = temperatures * moves_per_range * static_cast<long>(tally.start().size());
  const unsigned ranges = static_cast<unsigned>(std::clamp(planned / moves, 1L, 1'000'000L));
  return pagmo::algorithm(pagmo::simulated_annealing(warmest, coldest * warmest, temperatures, ranges,
                                                     moves_per_range, 1.0, seed));
}

pagmo::algorithm algorithm(PagmoMethod method, const PagmoOptions& options, Tally& tally,
                           pagmo::population& population) {
  const unsigned seed = static_cast<unsigned>(options.seed);
  const unsigned generations = static_cast<unsigned>(
      std::min(2'000'000'000L, tally.evaluations_left() + 1));  // the tally ends it sooner
  const double step = options.smallest_step;
  constexpr double even = 0;  // values as near as this end a search: only when there is nothing to choose
  constexpr double by_method = -1;
  switch (method) {
    case PagmoMethod::cma_es:
      return pagmo::algorithm(pagmo::cmaes(generations, by_method, by_method, by_method, by_method, 0.5, even,
                                           step, false, true, seed));
    case PagmoMethod::differential_evolution:
      return pagmo::algorithm(pagmo::de(generations, 0.8, 0.9, 2u, even, step, seed));
    case PagmoMethod::self_adaptive_de:
      return pagmo::algorithm(pagmo::sade(generations, 2u, 1u, even, step, false, seed));
    case PagmoMethod::particle_swarm:
      return pagmo::algorithm(pagmo::pso(generations, 0.7298, 2.05, 2.05, 0.5, 5u, 2u, 4u, false, seed));
    case PagmoMethod::genetic:
      return pagmo::algorithm(
          pagmo::sga(generations, 0.9, 10.0, 0.1, 20.0, 2u, "sbx", "polynomial", "tournament", seed));
    case PagmoMethod::simulated_annealing:
      return annealing(tally, population, options.annealing_evaluations, seed);
    case PagmoMethod::compass:
      break;
  }
  return pagmo::algorithm(pagmo::compass_search(generations, 0.1, step, 0.5));
}

void evolve(const Problem& problem, PagmoMethod method, const PagmoOptions& options, Tally& tally) {
  const UntrappedFloats
      untrapped;  // pagmo's annealing takes exp of what overflows where nothing can be built
  pagmo::population population(pagmo::problem(Objective{&tally}), 0, static_cast<unsigned>(options.seed));
  population.push_back(tally.start(), {tally.start_value()});
  for (int i = 1; i < pagmo_population(method, options, problem.variables.size()); ++i)
    population.push_back(population.random_decision_vector());
  algorithm(method, options, tally, population).evolve(population);
}

}  // namespace

int pagmo_population(PagmoMethod method, const PagmoOptions& options, std::size_t variables) {
  constexpr int usual = 20;
  const int n = static_cast<int>(variables);
  switch (method) {
    case PagmoMethod::cma_es:  // at least 5 for pagmo; Hansen's 4 + 3 ln n is 6 for two variables
      return std::max(
          5, options.population ? options.population : std::max(10, 4 + static_cast<int>(3 * std::log(n))));
    case PagmoMethod::differential_evolution:
    case PagmoMethod::self_adaptive_de:
      return std::max(7, options.population ? options.population : std::max(usual, 5 * n));
    case PagmoMethod::particle_swarm:
      return std::max(2, options.population ? options.population : usual);
    case PagmoMethod::genetic: {  // in pairs
      const int size = std::max(4, options.population ? options.population : std::max(usual, 5 * n));
      return size + size % 2;
    }
    case PagmoMethod::simulated_annealing:
    case PagmoMethod::compass:
      break;
  }
  return 1;
}

Outcome pagmo_search(const Problem& problem, PagmoMethod method, const PagmoOptions& options) {
  Tally tally(problem, options.limits, pagmo_population(method, options, problem.variables.size()));
  require_finite_box(problem);
  try {
    if (tally.begin() && (tally.found() || method != PagmoMethod::compass))
      evolve(problem, method, options, tally);
  } catch (const Tally::Over&) {  // the tally knows why
  }
  return tally.finish(Ending::converged, from_one_point(method)
                                             ? "its steps have become as small as asked for"
                                             : "the population has drawn together");
}

}  // namespace catoptric::optim
