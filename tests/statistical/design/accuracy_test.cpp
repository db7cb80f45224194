#include <boost/math/distributions/binomial.hpp>
#include <catch2/catch.hpp>
#include <cmath>

#include "design/evaluator.h"
#include "design/judge.h"
#include "design/run.h"
#include "design/stage.h"
#include "sim/closed_forms.h"
#include "sim/simulation.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

const std::string data = CATOPTRIC_DATA;

/// Total irradiance by the closed form, or by photons of their own to a tenth of the accuracy.
std::vector<double> truth(const Scene& scene, const Profile& profile,
                          std::span<const sim::FieldSample> samples, double accuracy) {
  const Stage stage(scene, profile);
  if (const auto form = sim::closed_form(stage.scene, samples))
    return sum(sim::direct_field(stage.scene, samples), form->reflected);
  sim::AccuracyRequest request;
  request.relative = 0.1 * accuracy;
  request.photons = scene.model.photons;
  request.photons.seed = 987654321;
  request.most_photons = 4'000'000'000;
  const sim::AccurateField field = sim::reach_accuracy(stage.scene, samples, request);
  REQUIRE(field.proven);
  return sum(field.direct, field.reflected);
}

struct Kept {
  int proven = 0, held = 0, held_by_fifth = 0;
  int within = 0;  ///< of the error that was stated
};

/// The leaning screen moved to where the beam's edge crosses it.
const std::vector<Override> across_the_edge{{"near_field.center", "[70, 0, -40]", "test"}};

/// The same screen so large that the beam is a spot on a seventieth of it.
const std::vector<Override> spot_on_a_wall{{"near_field.center", "[0, 0, -40]", "test"},
                                           {"near_field.width", "1600", "test"},
                                           {"near_field.height", "1600", "test"},
                                           {"near_field.samples", "4000", "test"}};

/// @in changed: of the file's settings
Kept keep(const std::string& file, double accuracy, std::uint64_t seeds, sim::Rung expected,
          std::vector<Override> changed = {}) {
  changed.push_back({"accuracy", std::to_string(accuracy), "test"});
  Scene scene = read_scene(data + file, changed);
  const Profile profile = start_profile(scene);
  const Target target{scene.near_field.samples(scene.samples), {}};
  const std::vector<double> exact = truth(scene, profile, target.samples, accuracy);
  Kept kept;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    scene.model.photons.seed = 100 + seed;
    const Judgement judged = judge_to_accuracy(scene, target, profile, 1, false, {});
    CHECK(judged.rung == expected);
    kept.proven += judged.accuracy->proven;
    const double error =
        root_mean_square_error(sum(judged.direct, judged.reflected), exact) / root_mean_square(exact);
    kept.held += error <= accuracy;
    kept.held_by_fifth += error <= accuracy / 5;
    kept.within += error <= judged.accuracy->error95_rel;
  }
  return kept;
}

void check_hundred(const std::string& file, double accuracy, sim::Rung rung,
                   const std::vector<Override>& changed = {}) {
  const Kept kept = keep(file, accuracy, 100, rung, changed);
  std::printf("%-32s %-15s accuracy %.3f: proven %d, held %d, within what was stated %d of 100\n",
              file.c_str(), changed.empty() ? "" : "across the edge", accuracy, kept.proven, kept.held,
              kept.within);
  CHECK(kept.proven == 100);
  CHECK(kept.held >= 95);
  CHECK(kept.within >= 90);  // 95 expected at least, less 2.3 standard deviations
}

}  // namespace

TEST_CASE("an accuracy that is proven holds in 95 of 100 seeds: a few seeds of the short examples",
          "[long]") {
  constexpr int seeds = 20;
  const Kept tilted = keep("/examples/tilted_screen.toml", 0.02, seeds, sim::Rung::photons);
  const Kept floor = keep("/examples/diffusing_floor.toml", 0.02, seeds, sim::Rung::rings);
  for (const Kept& kept : {tilted, floor}) {
    CHECK(kept.proven == seeds);
    // Fewer than 16 of 20 would come in 0.03 % of the cases.
    CHECK(kept.held >= 16);
    CHECK(kept.held_by_fifth < 16);  // wrong twin: five times as accurate it is not
  }
}

TEST_CASE("what is stated of a field with a jump holds too: bias is counted as a jump's", "[long]") {
  constexpr int seeds = 20;
  for (const double accuracy : {0.1, 0.05}) {
    const Kept kept =
        keep("/examples/tilted_screen.toml", accuracy, seeds, sim::Rung::photons, across_the_edge);
    CHECK(kept.proven == seeds);
    // Fewer than 16 of 20 would come in 0.03 % of the cases; with a smooth field's bias it was half of them.
    CHECK(kept.within >= 16);
  }
}

TEST_CASE("what is stated holds where all the light falls between most of the few samples looked at first") {
  constexpr int seeds = 20;
  const Kept kept = keep("/examples/tilted_screen.toml", 0.3, seeds, sim::Rung::photons, spot_on_a_wall);
  CHECK(kept.proven == seeds);
  CHECK(kept.within >= 16);  // judged by 128 of the 4,000 samples none of 20 held
}

TEST_CASE("an accuracy holds in 95 of 100 seeds on every example scene", "[.long]") {
  struct Case {
    const char* file;
    sim::Rung rung;
  };
  for (const Case& each :
       {Case{"/examples/tilted_screen.toml", sim::Rung::photons},
        Case{"/examples/source_aside.toml", sim::Rung::photons},
        Case{"/examples/diffusing_floor.toml", sim::Rung::rings},
        Case{"/paper/paraboloid.toml", sim::Rung::tubes}, Case{"/paper/start_c.toml", sim::Rung::tubes}})
    for (const double accuracy : {0.05, 0.02, 0.01, 0.005}) check_hundred(each.file, accuracy, each.rung);
  for (const double accuracy : {0.1, 0.05})
    check_hundred("/examples/tilted_screen.toml", accuracy, sim::Rung::photons, across_the_edge);
}
