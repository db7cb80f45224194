#include "optim/nelder_mead.h"

#include <nlopt.h>

#include <cmath>
#include <exception>
#include <memory>

#include "optim/tally.h"

namespace catoptric::optim {
namespace {

/// What NLopt hands back to us; no exception may pass through its C.
struct Call {
  Tally& tally;
  nlopt_opt solver;
  std::exception_ptr failure;
};

double value_for_nlopt(unsigned count, const double* x, double*, void* data) {
  Call& call = *static_cast<Call*>(data);
  try {
    if (!call.failure) return call.tally.evaluate({x, count});
  } catch (const Tally::Over&) {  // the tally knows why
  } catch (...) {
    call.failure = std::current_exception();
  }
  nlopt_force_stop(call.solver);
  return HUGE_VAL;
}

}  // namespace

Outcome nelder_mead(const Problem& problem, const NelderMeadOptions& options) {
  Tally tally(problem, options.limits, 1);
  if (tally.begin() && tally.found()) {
    std::vector<double> x = tally.start();
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> solver(
        nlopt_create(NLOPT_LN_NELDERMEAD, static_cast<unsigned>(x.size())), nlopt_destroy);
    Call call{tally, solver.get(), nullptr};
    nlopt_set_min_objective(solver.get(), value_for_nlopt, &call);
    nlopt_set_lower_bounds(solver.get(), tally.lower().data());
    nlopt_set_upper_bounds(solver.get(), tally.upper().data());
    nlopt_set_initial_step(solver.get(), tally.step().data());
    nlopt_set_xtol_rel(solver.get(), options.step_tolerance);
    nlopt_set_ftol_rel(solver.get(), options.value_tolerance);
    double value = 0;
    nlopt_optimize(solver.get(), x.data(), &value);
    if (call.failure) std::rethrow_exception(call.failure);
  }
  return tally.finish(Ending::converged, "the simplex has become as small as asked for");
}

}  // namespace catoptric::optim
