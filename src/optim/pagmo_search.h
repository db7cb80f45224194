#pragma once

#include <cstdint>

#include "optim/outcome.h"
#include "optim/problem.h"
#include "optim/search_limits.h"

namespace catoptric::optim {

/// The searches that come from pagmo2. All but `compass` look over the whole box.
enum class PagmoMethod {
  cma_es,                  ///< covariance matrix adaptation: Hansen 2006
  differential_evolution,  ///< Storn & Price 1997, variant rand/1/exp
  self_adaptive_de,        ///< the same with control parameters that adapt: Brest & others 2006
  particle_swarm,          ///< Kennedy & Eberhart 1995, with a constriction factor
  simulated_annealing,     ///< Corana & others 1987, from the start
  genetic,                 ///< simulated binary crossover, polynomial mutation: Deb & Agrawal 1995
  compass,                 ///< one step along each axis, halved after a failure: Kolda & others 2003; local
};

struct PagmoOptions {
  SearchLimits limits;
  std::uint64_t seed = 1;
  int population = 0;  ///< 0: what suits the method, see pagmo_population
  double smallest_step =
      1e-8;  ///< spread of the population, or the compass's step, over the box, that ends it
  long annealing_evaluations = 10000;  ///< simulated_annealing: how slowly it cools; not the budget, so that
                                       ///< a search resumed with a larger one goes the same way
};

/// The population a method works with: the one asked for, raised to what the method needs.
int pagmo_population(PagmoMethod method, const PagmoOptions& options, std::size_t variables);

/// Searches the box by one of pagmo2's methods. One thread, the same bits every run with the same seed. The
/// problem's start is evaluated first and belongs to the first population; the others are drawn from the box.
/// @out   an iteration is one generation, or one evaluation of simulated_annealing and compass
/// @fails InputError as require_sound, for a budget below 1, or for a variable that can move without two
///        finite bounds; whatever the objective throws
/// @from  Biscani & Izzo, pagmo2 2.18
Outcome pagmo_search(const Problem& problem, PagmoMethod method, const PagmoOptions& options);

}  // namespace catoptric::optim
