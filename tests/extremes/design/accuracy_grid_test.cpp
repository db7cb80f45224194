#include <catch2/catch.hpp>
#include <cmath>

#include "design/evaluator.h"
#include "design/run.h"
#include "support/extreme_scenes.h"
#include "support/refusal.h"
#include "support/scaled_scene.h"

/// An accuracy asked of scenes drawn from a grid of extremes, by every rung: refused in words, or a field
/// whose stated error holds against ray tubes, which share no photon with it.
using namespace catoptric;
using namespace catoptric::design;

namespace {

constexpr double asked_rel = 0.05;

/// What was seen of one rung.
struct Found {
  std::size_t scenes = 0, refused = 0, proven = 0, open = 0;
  std::size_t compared = 0, held = 0;
  double worst = 0;  ///< error over what was stated
};

/// Nothing where the scene was refused in words.
std::optional<Judgement> judged(const test::ExtremeScene& drawn, const char* rung, Found& found) {
  ++found.scenes;
  try {
    const Scene scene =
        test::scene_of(drawn.parts, {{"accuracy", fmt::format("{}", asked_rel)}, {"model.rung", rung}});
    Judgement judgement = run_simulation(scene, {}).mirror.judgement;
    CHECK(test::defect(scene, judgement) == "");
    return judgement;
  } catch (const Error& error) {
    test::check_refusal(error);
    ++found.refused;
    return std::nullopt;
  }
}

void check_report(const AccuracyReport& report, Found& found) {
  CHECK(!report.sentence.empty());
  CHECK(report.spent_photons <= 20000);
  CHECK(report.error95_rel >= 0);
  CHECK(report.proven == (report.error95_rel <= asked_rel));
  ++(report.proven ? found.proven : found.open);
}

/// @in truth: by ray tubes, proven
void compare(const Judgement& judgement, const Judgement& truth, Found& found) {
  const std::vector<double> exact = sum(truth.direct, truth.reflected);
  const double size = root_mean_square(exact);
  if (!(size > 0)) return;
  const double error_rel = root_mean_square_error(sum(judgement.direct, judgement.reflected), exact) / size;
  const double stated_rel = judgement.accuracy->error95_rel + truth.accuracy->error95_rel;
  INFO("off by " << error_rel << ", stated " << stated_rel);
  ++found.compared;
  found.held += error_rel <= stated_rel;
  found.worst = std::max(found.worst, error_rel / std::max(stated_rel, 1e-15));
  CHECK(error_rel <= 3 * stated_rel + 1e-9);
}

struct ByRung {
  Found tubes, rings, photons;
};

/// Scenes of these numbers, by every rung.
ByRung run(std::uint64_t first, std::uint64_t end) {
  ByRung found;
  for (std::uint64_t number = first; number < end; ++number) {
    const test::ExtremeScene drawn = test::extreme_scene(number);
    INFO("scene " << number << ":\n" << drawn.parts);
    const std::optional<Judgement> truth = judged(drawn, "tubes", found.tubes);
    if (truth) check_report(*truth->accuracy, found.tubes);
    for (const auto& [rung, of_rung] :
         {std::pair{"rings", &found.rings}, std::pair{"photons", &found.photons}}) {
      INFO(rung);
      const std::optional<Judgement> judgement = judged(drawn, rung, *of_rung);
      if (!judgement) continue;
      check_report(*judgement->accuracy, *of_rung);
      if (truth && truth->accuracy->proven) compare(*judgement, *truth, *of_rung);
    }
  }
  // 95 % expected at least; fewer come once in a thousand times.
  for (const Found* of_rung : {&found.rings, &found.photons}) {
    const double n = static_cast<double>(of_rung->compared);
    CHECK(static_cast<double>(of_rung->held) >= 0.95 * n - 3.1 * std::sqrt(0.95 * 0.05 * n));
  }
  return found;
}

}  // namespace

TEST_CASE("an accuracy asked of scenes from a grid of extremes is refused in words, or its error holds",
          "[long]") {
  const ByRung found = run(98, 120);
  CHECK(found.rings.compared + found.photons.compared > 5);
}

TEST_CASE("the same with seventy scenes", "[.][extremes]") {
  const ByRung found = run(50, 120);
  for (const auto& [rung, of_rung] : {std::pair{"tubes", &found.tubes}, std::pair{"rings", &found.rings},
                                      std::pair{"photons", &found.photons}})
    fmt::print(
        "| accuracy of {} | {} scenes | {} refused, {} proven, {} not | {} held against tubes, of {} | "
        "{:.2f} of what was stated |\n",
        rung, of_rung->scenes, of_rung->refused, of_rung->proven, of_rung->open, of_rung->held,
        of_rung->compared, of_rung->worst);
}
