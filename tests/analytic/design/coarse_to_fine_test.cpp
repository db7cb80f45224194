#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "design/evaluator.h"
#include "design/run.h"
#include "design/search.h"
#include "design/search_methods.h"
#include "optim/least_squares.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

Scene start_a(std::vector<Override> changes) {
  changes.push_back({"model.rung", "tubes", "test"});
  changes.push_back({"model.interactions", "4", "test"});  // far corners of the box are deep cavities
  changes.push_back({"near_field.samples", "100", "test"});
  return read_scene(std::string(CATOPTRIC_DATA) + "/paper/start_a.toml", changes);
}

optim::Outcome searched(const Scene& scene) {
  return search(scene, sim::Rung::tubes, make_target(scene), {});
}

/// How far a column of the Jacobian, times a factor, is from differences of the residuals, relative.
double derivative_error(const optim::LeastSquaresProblem& problem, const std::vector<double>& x,
                        const std::vector<double>& jacobian, std::size_t column, double factor) {
  constexpr double step = 1e-3;
  std::vector<double> up = x, down = x, plus(problem.residual_count), minus(problem.residual_count);
  up[column] += step;
  down[column] -= step;
  if (!problem.evaluate(up, plus, nullptr) || !problem.evaluate(down, minus, nullptr)) return HUGE_VAL;
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < plus.size(); ++i) {
    const double slope = (plus[i] - minus[i]) / (2 * step);
    difference += std::pow(slope - factor * jacobian[i * x.size() + column], 2);
    size += slope * slope;
  }
  return std::sqrt(difference / size);
}

}  // namespace

TEST_CASE("from a wide kernel to a narrow one, start A finds the paraboloid where it runs away otherwise") {
  for (const char* radius : {"10", "20"}) {
    INFO("near field of " << radius << " cm");
    const optim::Outcome plain = searched(start_a({{"near_field.radius", radius, "test"}}));
    CHECK(plain.best[0] > 2);  // 20, and 3.7
    const optim::Outcome staged = searched(
        start_a({{"near_field.radius", radius, "test"}, {"search.kernels", "[6, 3, 1.5, 0.75]", "test"}}));
    CHECK(staged.best[0] == Approx(1).margin(0.01));
    CHECK(staged.best[1] == Approx(10).margin(0.1));
    CHECK(staged.value < 0.1 * plain.value);
    CHECK(staged.start_value == plain.start_value);
    CHECK(staged.history.front().move == "start, kernel 6 cm");
    CHECK(staged.history.back().move.ends_with("own kernel"));
    CHECK(staged.history.back().evaluations <= staged.evaluations);
  }
}

TEST_CASE("a blurred target is what the paraboloid's light is through the same kernel") {
  const Scene scene = start_a(
      {{"model.kernel_radius", "2", "test"}, {"near_field.radius", "9", "test"}});  // the rim is at 10
  const Target sharp = make_target(scene), target = blurred_target(scene);
  const Profile paraboloid(2, scene.profile.knots(), {{0, 100, 1}, {50, 100, 1}, {100, 50, 1}});
  const std::vector<double> lit =
      total_by_rung(scene, sim::Rung::tubes, paraboloid, target.samples, search_stream);
  double worst = 0, moved = 0;
  for (std::size_t i = 0; i < lit.size(); ++i) {
    worst = std::max(worst, to_w_per_m2(std::abs(target.irradiance_w_per_mm2[i] - lit[i])));
    moved = std::max(moved,
                     to_w_per_m2(std::abs(target.irradiance_w_per_mm2[i] - sharp.irradiance_w_per_mm2[i])));
  }
  CHECK(worst < 1e-6);  // what tubes are asked for in this scene
  CHECK(moved > 0.01);  // the blur is what the test is about
}

TEST_CASE("the fit's norm is the scene's objective, and its derivatives are those of the residuals") {
  for (const char* free : {"\"listed\"", "\"profile\""})
    for (const char* metric : {"rmse", "relative-rmse"}) {
      INFO(free << ", " << metric);
      const Scene scene = start_a({{"search.metric", metric, "test"}, {"search.free", free, "test"}});
      const Target target = make_target(scene);
      const optim::LeastSquaresProblem problem = fit_problem(scene, target);
      std::vector<double> x = starts(scene.variables);
      for (std::size_t j = 0; j < x.size(); ++j) {
        if (scene.variables[j].name == "w1") x[j] = 1.3;
        if (scene.variables[j].name == "logw1") x[j] = std::log(1.3);
        if (scene.variables[j].name == "r2") x[j] = 9.4;
      }
      REQUIRE(x.size() == (scene.search.free == Freedom::profile ? 5 : 2));
      std::vector<double> residuals(problem.residual_count), jacobian(x.size() * residuals.size());
      REQUIRE(problem.evaluate(x, residuals, jacobian.data()));
      double square = 0;
      for (const double each : residuals) square += each * each;
      CHECK(std::sqrt(square) ==
            Approx(value_at(scene, sim::Rung::tubes, target, family_of(scene), x)).epsilon(1e-4));
      for (std::size_t j = 0; j < x.size(); ++j) {
        INFO(scene.variables[j].name);
        CHECK(derivative_error(problem, x, jacobian, j, 1) < 0.01);
        // a weight's derivative that is no logarithm's, or a length's in another unit, would be seen
        CHECK(derivative_error(problem, x, jacobian, j, 1 / 1.3) > 0.2);
      }
    }
}
