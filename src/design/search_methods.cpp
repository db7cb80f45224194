#include "design/search_methods.h"

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "base/errors.h"
#include "design/constraints.h"
#include "design/search.h"
#include "design/shared_work.h"
#include "optim/hooke_jeeves.h"
#include "optim/least_squares.h"
#include "optim/multi_start.h"
#include "optim/nelder_mead.h"
#include "optim/pagmo_search.h"

namespace catoptric::design {
namespace {

/// Share of a pattern search that is done, by the step: it must be halved so many times in all.
double share_done(const Scene& scene, double step) {
  const double share = std::log(step) / std::log(scene.search.smallest_step);
  return std::isfinite(share) ? std::min(1.0, std::max(0.0, share)) : 0.0;
}

/// Tells the watcher of every evaluation.
class Telling {
 public:
  Telling(const Scene& scene, const RunControl& control) : scene_(scene), control_(control) {}

  double evaluated(double value) {
    ++evaluations_;
    if (value < infeasible_floor && (std::isnan(best_) || value < best_)) best_ = value;
    const double spent =
        static_cast<double>(evaluations_) / static_cast<double>(scene_.search.most_evaluations);
    control_.tell({"search", std::max(share_, spent), best_, evaluations_, {}, iterations_});
    return value;
  }
  void iterated(const optim::Iterate& iterate) { iterations_ = iterate.iteration; }
  void stepped(double step) { share_ = share_done(scene_, step); }

 private:
  const Scene& scene_;
  const RunControl& control_;
  long evaluations_ = 0, iterations_ = 0;
  double best_ = std::numeric_limits<double>::quiet_NaN(), share_ = 0;
};

optim::Outcome by_hooke_jeeves(const SearchSpec& spec, const optim::StartedSearch& one, Telling& telling) {
  optim::HookeJeevesOptions options;
  options.acceleration = spec.acceleration;
  options.reduction = spec.reduction;
  options.smallest_step = spec.smallest_step;
  options.most_evaluations = one.limits.most_evaluations;
  options.most_iterations = spec.most_iterations;
  options.reach = one.limits.reach;
  options.progress = [&](const optim::Iterate& iterate) {
    telling.iterated(iterate);
    telling.stepped(iterate.step);
    return true;
  };
  options.stop_requested = one.limits.stop_requested;
  return optim::hooke_jeeves(one.problem, options);
}

optim::Outcome by_fit(const Scene& scene, const Target& target, const optim::StartedSearch& one,
                      Telling& telling, optim::SearchTape* tape) {
  optim::LevenbergMarquardtOptions options;
  options.most_evaluations = one.limits.most_evaluations;
  options.most_iterations = scene.search.most_iterations;
  options.reach = one.limits.reach;
  options.progress = [&](const optim::Iterate& iterate) {
    telling.iterated(iterate);
    telling.evaluated(iterate.value);
    return true;
  };
  options.stop_requested = one.limits.stop_requested;
  optim::LeastSquaresProblem problem = fit_problem(scene, target);
  problem.variables = one.problem.variables;
  return optim::levenberg_marquardt(tape ? optim::remembering(problem, *tape) : problem, options);
}

std::optional<optim::PagmoMethod> pagmo_method(const std::string& method) {
  using enum optim::PagmoMethod;
  if (method == "cma-es") return cma_es;
  if (method == "differential-evolution") return differential_evolution;
  if (method == "self-adaptive-de") return self_adaptive_de;
  if (method == "particle-swarm") return particle_swarm;
  if (method == "simulated-annealing") return simulated_annealing;
  if (method == "genetic") return genetic;
  if (method == "compass") return compass;
  return std::nullopt;
}

optim::Outcome by_method(const Scene& scene, const Target& target, const optim::StartedSearch& one,
                         Telling& telling, optim::SearchTape* tape) {
  const SearchSpec& spec = scene.search;
  if (spec.method == "levenberg-marquardt") return by_fit(scene, target, one, telling, tape);
  if (spec.method == "nelder-mead") return optim::nelder_mead(one.problem, {.limits = one.limits});
  if (const auto method = pagmo_method(spec.method))
    return optim::pagmo_search(one.problem, *method,
                               {.limits = one.limits,
                                .seed = one.seed,
                                .population = spec.population,
                                .annealing_evaluations = spec.most_evaluations});
  if (spec.method == "hooke-jeeves") return by_hooke_jeeves(spec, one, telling);
  // A name that the table of keys has and this list has not: never another search under its name.
  throw std::logic_error("search.method \"" + spec.method + "\" has no search");
}

}  // namespace

optim::Problem light_problem(const Scene& scene, sim::Rung rung, const Target& target,
                             const SceneFamily& family, const RunControl& control,
                             Foresight::Rehearse rehearse) {
  optim::Problem light{scene.variables, [&, rung](std::span<const double> x) {
                         return value_at(scene, rung, target, family, x);
                       }};
  std::shared_ptr<Foresight> foresight;
  if (control.stopped_together) {
    foresight = std::make_shared<Foresight>(ranks_of(control), light, std::move(rehearse),
                                            scene.model.photons.stop, *control.stopped_together);
    light.evaluate = [foresight](std::span<const double> x) { return foresight->evaluate(x); };
  }
  const optim::Problem remembered = control.tape ? optim::remembering(light, *control.tape) : light;
  return {scene.variables, [foresight, evaluate = remembered.evaluate](std::span<const double> x) {
            try {
              const double value = evaluate(x);
              if (foresight) foresight->know(x, value);
              return value;
            } catch (const Interrupted&) {
              return std::numeric_limits<double>::infinity();
            }
          }};
}

optim::Outcome search_once(const Scene& scene, sim::Rung rung, const Target& target,
                           const RunControl& control) {
  const SceneFamily family = family_of(scene);
  const auto run = [&](const optim::Problem& problem, Telling& telling, optim::SearchTape* tape,
                       const std::function<bool()>& stop_requested) {
    optim::SearchLimits limits;
    limits.most_evaluations = scene.search.most_evaluations;
    if (scene.search.reach) limits.reach = *scene.search.reach;
    limits.stop_requested = stop_requested;
    const auto one_search = [&](const optim::StartedSearch& one) {
      return by_method(scene, target, one, telling, tape);
    };
    if (scene.search.restarts == 0) return one_search({problem, limits, scene.seed});
    return optim::multi_start(problem, one_search,
                              {.limits = limits, .most_restarts = scene.search.restarts, .seed = scene.seed});
  };
  const auto rehearse = [&](const optim::Problem& guessed, const std::function<bool()>& enough) {
    const RunControl nobody;
    Telling silent(scene, nobody);
    run(guessed, silent, nullptr, enough);
  };
  Telling telling(scene, control);
  const optim::Problem light = light_problem(scene, rung, target, family, control, rehearse);
  const optim::Problem problem{
      scene.variables, [&](std::span<const double> x) { return telling.evaluated(light.evaluate(x)); }};
  return run(problem, telling, control.tape, [&] { return control.stopped(); });
}

}  // namespace catoptric::design
