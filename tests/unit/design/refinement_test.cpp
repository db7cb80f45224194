#include "design/refinement.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "design/search.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

const Profile base(2, {0, 0, 0, 0.4, 1, 1, 1}, {{0, 100, 1}, {30, 100, 0.8}, {70, 85, 1.5}, {100, 50, 1.2}});

double greatest_distance(const Profile& one, const Profile& other) {
  double worst = 0;
  for (int i = 0; i <= 500; ++i) {
    const MeridianPoint p = one.at(i / 500.0), q = other.at(i / 500.0);
    worst = std::max(worst, std::hypot(p.r_mm - q.r_mm, p.z_mm - q.z_mm));
  }
  return worst;
}

Scene free_scene(const std::string& refine) {
  return read_scene(std::string(CATOPTRIC_DATA) + "/paper/start_a.toml",
                    {{"search.free", "\"profile\"", "test"},
                     {"search.refine", refine, "test"},
                     {"search.most_evaluations", "100", "test"},
                     {"search.most_iterations", "50", "test"},
                     {"variables.source.power.step", "0.001", "test"},
                     {"variables.source.power.lower", "0.01", "test"},
                     {"variables.source.power.upper", "0.1", "test"}});
}

/// A search that spends 30 evaluations and moves the power.
optim::Outcome spend(const Scene& scene) {
  optim::Outcome outcome{};
  outcome.ending = optim::Ending::converged;
  outcome.best = starts(scene.variables);
  outcome.best.back() += 0.001;
  outcome.start_value = 2;
  outcome.value = 1;
  outcome.evaluations = 30;
  outcome.iterations = 4;
  outcome.successes = 3;
  outcome.history = {{0, 0, 1, 1, "start", starts(scene.variables), 2},
                     {3, 4, 30, 0.5, "step", outcome.best, 1}};
  return outcome;
}

}  // namespace

TEST_CASE("a refinement keeps the curve and adds control points", "[refinement]") {
  const Profile cubic = refined(base, "degree 3"), finer = refined(base, "spans 4");
  CHECK(cubic.degree() == 3);
  CHECK(cubic.points().size() > base.points().size());
  CHECK(greatest_distance(cubic, base) < 1e-11);
  CHECK(finer.degree() == 2);
  CHECK(finer.spans().size() == 4);
  CHECK(finer.points().size() == 6);
  CHECK(greatest_distance(finer, base) < 1e-11);
  const Profile both = refined(cubic, "spans 6");
  CHECK(both.spans().size() == 6);
  CHECK(greatest_distance(both, base) < 1e-11);
  // the distance would show a curve that moved
  std::vector<ControlPoint> moved = finer.points();
  moved[2].z_mm += 1e-6;
  CHECK(greatest_distance(Profile(2, finer.knots(), moved), base) > 1e-7);
}

TEST_CASE("steps that add no freedom, or are none, are refused", "[refinement]") {
  for (const char* step : {"degree", "degree ", "degree x", "degree 3x", "degre 3", "", "3", "degree  3"}) {
    INFO(step);
    CHECK_THROWS_WITH(refined(base, step), Catch::Contains("is no refinement"));
  }
  CHECK_THROWS_WITH(refined(base, "degree 2"), Catch::Contains("no freedom"));
  CHECK_THROWS_AS(refined(base, "degree 10"), InputError);
  for (const char* step : {"spans 2", "spans 3", "spans 0", "spans -4"}) {
    INFO(step);
    CHECK_THROWS_WITH(refined(base, step), Catch::Contains("alike"));
  }
}

TEST_CASE("stages share one budget, begin where the last one ended and take smaller steps", "[refinement]") {
  const Scene scene = free_scene("[\"degree 3\", \"spans 2\"]");
  std::vector<Scene> seen;
  const RefinedOutcome found = search_in_stages(scene, [&](const Scene& stage) {
    seen.push_back(stage);
    return spend(stage);
  });
  REQUIRE(seen.size() == 3);
  CHECK(seen[1].search.most_evaluations == 70);
  CHECK(seen[2].search.most_evaluations == 40);
  CHECK(seen[1].search.most_iterations == 46);
  CHECK(seen[1].profile.degree() == 3);
  CHECK(seen[2].profile.spans().size() == 2);
  CHECK(greatest_distance(seen[2].profile, scene.profile) < 1e-11);  // spend() does not move the shape
  CHECK(seen[0].variables.size() < seen[1].variables.size());
  CHECK(seen[1].variables.size() < seen[2].variables.size());
  CHECK(seen[1].variables[1].step == Approx(0.25 * 0.1 * std::hypot(9, 5)).epsilon(1e-6));  // r1, in cm
  CHECK(seen[2].variables.back().name == "source.power");
  CHECK(seen[2].variables.back().start == Approx(scene.variables.back().start + 0.002).epsilon(1e-12));

  CHECK(found.outcome.evaluations == 90);
  CHECK(found.outcome.iterations == 12);
  CHECK(found.outcome.start_value == 2);
  REQUIRE(found.outcome.history.size() == 6);
  CHECK(found.outcome.history[2].move == "degree 3");
  CHECK(found.outcome.history[2].evaluations == 31);
  CHECK(found.outcome.history[5].k == 9);
  CHECK(found.last.variables.size() == found.outcome.best.size());
  REQUIRE(found.stages.size() == 3);
  CHECK(found.stages[0].step.empty());
  CHECK(found.stages[2].step == "spans 2");
  CHECK(found.stages[2].evaluations == 30);
  CHECK(found.stages[2].points == 5);
}

TEST_CASE("a search that did not converge, or left nothing, is not refined", "[refinement]") {
  const Scene scene = free_scene("[\"degree 3\"]");
  int calls = 0;
  const auto run = [&](optim::Ending ending, long evaluations) {
    calls = 0;
    return search_in_stages(scene, [&](const Scene& stage) {
      ++calls;
      optim::Outcome outcome = spend(stage);
      outcome.ending = ending;
      outcome.evaluations = evaluations;
      return outcome;
    });
  };
  CHECK(run(optim::Ending::stopped, 30).stages.size() == 1);
  CHECK(run(optim::Ending::target_reached, 30).stages.size() == 1);
  CHECK(run(optim::Ending::converged, 100).stages.size() == 1);
  CHECK(calls == 1);
  CHECK(run(optim::Ending::converged, 99).stages.size() == 2);
  CHECK(calls == 2);
}

TEST_CASE("refinement without a free profile is refused when the scene is read", "[refinement]") {
  const auto read = [](const std::string& free, const std::string& refine) {
    return read_scene(std::string(CATOPTRIC_DATA) + "/paper/start_a.toml",
                      {{"search.free", free, "test"}, {"search.refine", refine, "test"}});
  };
  CHECK_THROWS_WITH(read("\"listed\"", "[\"degree 3\"]"), Catch::Contains("search.refine"));
  CHECK_THROWS_WITH(read("\"curvature\"", "[\"degree 3\"]"), Catch::Contains("search.refine"));
  CHECK_THROWS_WITH(read("\"profile\"", "[\"degree 3\", \"degree 3\"]"),
                    Catch::Contains("search.refine") && Catch::Contains("no freedom"));
  CHECK(read("\"profile\"", "[\"degree 3\", \"spans 2\"]").search.refine.size() == 2);
}
