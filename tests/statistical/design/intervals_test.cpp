#include <catch2/catch.hpp>
#include <cmath>

#include "design/evaluator.h"
#include "design/judge.h"
#include "design/metrics.h"
#include "design/run.h"
#include "support/statistics.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

struct Coverage {
  std::size_t fields = 0, field_held = 0, field_held_by_half = 0;
  std::size_t objectives = 0, objective_held = 0, objective_held_by_half = 0;
  double field_share() const { return static_cast<double>(field_held) / static_cast<double>(fields); }
  double objective_share() const {
    return static_cast<double>(objective_held) / static_cast<double>(objectives);
  }
};

/// The paper's paraboloid against the target of one of another focal length, so that the objective is far
/// from 0; truth by eq. 12 and 13.
Coverage cover(const char* rung, const char* sampler, int seeds) {
  Scene scene = read_scene(std::string(CATOPTRIC_DATA) + "/paper/paraboloid.toml",
                           {{"model.rung", rung, "test"},
                            {"model.sampler", sampler, "test"},
                            {"model.photons", "16000", "test"},
                            {"near_field.samples", "12", "test"},
                            {"target.focal_length", "6", "test"}});
  const Profile profile = start_profile(scene);
  const Target target = make_target(scene);
  std::vector<double> exact;
  for (const sim::FieldSample& sample : target.samples)
    exact.push_back(
        paraboloid_reflected_w_per_mm2(scene.source.power_w, 50, 100, sample.point_mm.head<2>().norm()));
  Coverage seen;
  for (int seed = 0; seed < seeds; ++seed) {
    scene.model.photons.seed = 5000 + static_cast<std::uint64_t>(seed);
    const Judgement judged = judge(scene, target, profile, *scene.model.rung, 1);
    for (std::size_t i = 0; i < exact.size(); i += 4) {  // samples so far apart that they share few photons
      const double off = std::abs(judged.reflected[i] - judged.bias[i] - exact[i]);
      ++seen.fields;
      seen.field_held += off <= judged.half_interval[i];
      seen.field_held_by_half += off <= 0.5 * judged.half_interval[i];
    }
    const double truth = objective(scene, sum(judged.direct, exact), target);
    const double off = std::abs(judged.objective.value - judged.objective.bias - truth);
    ++seen.objectives;
    seen.objective_held += off <= *judged.objective.half_interval;
    seen.objective_held_by_half += off <= 0.5 * *judged.objective.half_interval;
  }
  return seen;
}

constexpr const char* rungs[] = {"photons", "rings"};
constexpr const char* samplers[] = {"random", "sobol"};

}  // namespace

TEST_CASE("the 95 % intervals of field and objective hold the truth for 95 % of 150 seeds", "[long]") {
  for (const char* rung : rungs)
    for (const char* sampler : samplers) {
      const Coverage seen = cover(rung, sampler, 150);
      CAPTURE(rung, sampler, seen.field_share(), seen.objective_share());
      CHECK(test::plausible(test::binomial_p(seen.field_held, seen.fields, 0.95)));
      CHECK(test::plausible(test::binomial_p(seen.objective_held, seen.objectives, 0.95)));
      // wrong twin: half as wide
      CHECK(test::rejected(test::binomial_p(seen.field_held_by_half, seen.fields, 0.95)));
      CHECK(test::rejected(test::binomial_p(seen.objective_held_by_half, seen.objectives, 0.95)));
    }
}

TEST_CASE("the 95 % intervals hold the truth for 93 to 97 % of 1000 seeds", "[.long]") {
  for (const char* rung : rungs)
    for (const char* sampler : samplers) {
      const Coverage seen = cover(rung, sampler, 1000);
      std::printf("%-8s %-7s field %.3f objective %.3f\n", rung, sampler, seen.field_share(),
                  seen.objective_share());
      CHECK(seen.field_share() > 0.93);
      CHECK(seen.field_share() < 0.97);
      CHECK(seen.objective_share() > 0.93);
      CHECK(seen.objective_share() < 0.97);
    }
}
