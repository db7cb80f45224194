#include "sim/ladder_error.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/random_stream.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr std::size_t samples = 400;

/// A made-up ladder: at each level the truth plus a bias that falls by a factor a step, plus noise that
/// doubles its square a step by an independent part: a narrower kernel sees half of the photons of the wider
/// one.
struct Made {
  double bias = 0, second_share = 0.5, fourth_share = 0.25, noise = 0;
  std::size_t sets = 4, levels = 8;
  std::uint64_t seed = 1;
};

double normal(RandomStream& stream) {
  const double first = stream.uniform(), second = stream.uniform();
  return std::sqrt(-2 * std::log1p(-first)) * std::cos(6.283185307179586 * second);
}

BandwidthLadder make(const Made& made) {
  BandwidthLadder ladder;
  SetFields noise(made.sets, std::vector<double>(samples, 0.0));
  for (std::size_t level = 0; level < made.levels; ++level) {
    const double step = static_cast<double>(level);
    const double added = made.noise * std::sqrt(static_cast<double>(made.sets)) *
                         (level == 0 ? 1.0 : std::pow(2.0, (step - 1) / 2));
    LadderLevel at;
    at.kernel_radius_mm = std::pow(0.5, step / 2);
    at.independent = samples;
    for (std::size_t set = 0; set < made.sets; ++set) {
      RandomStream stream(made.seed, Purpose::test, level * 100 + set);
      std::vector<double> second, fourth;
      for (std::size_t i = 0; i < samples; ++i) {
        const double sign = i % 2 == 0 ? 1 : -1;
        noise[set][i] += added * normal(stream);
        second.push_back(1 + sign * made.bias * std::pow(made.second_share, step) + noise[set][i]);
        fourth.push_back(1 + sign * made.bias * std::pow(made.fourth_share, step) + 2 * noise[set][i]);
      }
      at.second.push_back(second);
      at.fourth.push_back(fourth);
    }
    ladder.push_back(at);
  }
  return ladder;
}

/// The error that a choice really has.
double true_error(const BandwidthLadder& ladder, const LadderChoice& choice) {
  double square = 0;
  for (const double value : mean_of(fields_of(ladder[choice.level], choice.order)))
    square += (value - 1) * (value - 1) / samples;
  return std::sqrt(square);
}

}  // namespace

TEST_CASE("without noise the bias of a smooth field is the sum of the changes to come") {
  // Geometric: what is left at a level is what all narrower levels change together, within the tail's guess.
  const BandwidthLadder ladder = make({.bias = 0.1});
  const LadderChoice choice = best_choice(summary_of(ladder, false));
  CHECK(choice.order == 4);  // the same bias with a quarter left at each step
  CHECK(choice.noise == 0);
  CHECK(choice.level == 6);  // the last one whose change is known
  CHECK(choice.bias == Approx(true_error(ladder, choice)).epsilon(0.01));
}

namespace {

struct Held {
  int by_bound = 0, by_third = 0;
};

/// How many of 200 ladders the bound holds for.
Held hold(Made made, bool smooth) {
  Held held;
  for (int i = 0; i < 200; ++i) {
    made.seed = static_cast<std::uint64_t>(1000 + i);
    const auto ladder = make(made);
    const LadderChoice choice = best_choice(summary_of(ladder, smooth));
    const double error = true_error(ladder, choice);
    held.by_bound += error <= choice.error95;
    held.by_third += error <= choice.error95 / 3;
  }
  return held;
}

constexpr int enough = 178;  // 200 trials at 95 %: 190 with a standard deviation of 3.1; four of these

}  // namespace

TEST_CASE("the bound holds the true error for 95 % of ladders, smooth or with jumps", "[long]") {
  for (const double share : {0.5, 0.84})
    for (const double bias : {0.3, 1.0}) {  // far above the widest kernel's noise
      CAPTURE(share, bias);
      const double fourth_share = share > 0.5 ? share : share * share;  // a jump is a jump to any kernel
      const Held held = hold({bias, share, fourth_share, 0.01}, false);
      CHECK(held.by_bound >= enough);
      CHECK(held.by_third < 100);  // wrong twin: a bound three times narrower does not hold
    }
}

TEST_CASE("without bias the bound is the noise's, where the field is known to be smooth") {
  const Held held = hold({.noise = 0.01}, true);
  CHECK(held.by_bound >= enough);
  CHECK(held.by_third < 100);
  CHECK(hold({.noise = 0.01}, false).by_bound >= enough);  // and safe where that is not known
}

TEST_CASE("a jump that noise hides is within the bound unless the field is taken for smooth") {
  // What narrowing changes is a sixth of the bias, below its noise.
  const Made hidden{0.05, 0.84, 0.84, 0.01};
  CHECK(hold(hidden, false).by_bound >= enough);
  CHECK(hold(hidden, true).by_bound < enough);  // wrong twin
}

TEST_CASE("a narrow kernel is chosen where bias rules, a wide one where noise does") {
  const LadderChoice biased = best_choice(summary_of(make({.bias = 0.5, .noise = 1e-4}), false));
  const LadderChoice noisy = best_choice(summary_of(make({.bias = 0.001, .noise = 0.05}), false));
  CHECK(biased.level > noisy.level);
  CHECK(noisy.level == 0);
  CHECK(noisy.order == 2);
}

TEST_CASE("deviation of a mean over sets") {
  const SetFields sets{{1, 5}, {3, 5}};
  CHECK(mean_of(sets) == std::vector<double>{2, 5});
  CHECK(deviation_of_mean(sets)[0] == Approx(1));  // ((1-2)^2 + (3-2)^2) / (2 * 1)
  CHECK(deviation_of_mean(sets)[1] == 0);
}

TEST_CASE("more photons are expected to show the noise of fewer in a narrower kernel") {
  const LadderSummary today = summary_of(make({.noise = 0.01}), false);
  const LadderSummary twice = expected_with(today, 2);
  REQUIRE(twice.levels.size() == today.levels.size() + 1);  // one more kernel with as many photons as before
  for (std::size_t level = 1; level + 1 < today.levels.size(); ++level)
    for (const std::size_t order : {0, 1}) {
      const LadderReading &now = today.levels[level - 1].orders[order],
                          &then = twice.levels[level].orders[order];
      CHECK(then.variance == Approx(now.variance).epsilon(0.15));
      CHECK(then.change_variance == Approx(now.change_variance).epsilon(0.15));
    }
  // The made noise is that of random photons: half of it with twice the photons, in a kernel of any size.
  CHECK(twice.levels[0].orders[0].variance == Approx(0.5 * today.levels[0].orders[0].variance).epsilon(0.2));
}

TEST_CASE("the error of more photons is foreseen") {
  // A smooth bias that the widest kernels show; photons by the factor take the noise's square down by it.
  for (const double times : {4.0, 16.0}) {
    const LadderSummary today = summary_of(make({.bias = 0.3, .noise = 0.01}), false);
    const double expected = best_choice(expected_with(today, times)).error95;
    const double found =
        best_choice(
            summary_of(make({.bias = 0.3, .noise = 0.01 / std::sqrt(times), .levels = 10, .seed = 7}), false))
            .error95;
    CAPTURE(times, expected, found);
    CHECK(expected < 1.25 * found);
    CHECK(found < 1.25 * expected);
    CHECK(expected < 0.8 * best_choice(today).error95);  // wrong twin: that photons change nothing
  }
}

TEST_CASE("kernels without a photon may hide the light of three, all in one place") {
  BandwidthLadder dark = make({.bias = 0, .noise = 0, .sets = 4, .levels = 3});
  const LadderPhotons photons{0.5, 100};
  CHECK(best_choice(summary_of(dark, true, {}, photons)).error95 == 0);  // no sample is dark
  for (LadderLevel& level : dark)
    for (SetFields* fields : {&level.second, &level.fourth})
      for (auto& field : *fields) std::fill(field.begin(), field.end(), 0.0);
  const LadderSummary summary = summary_of(dark, true, {}, photons);
  // The widest kernel, of radius 1, hides least: brightest 1.5 W on its area, on its share of the field.
  const double kernel = 3.14159265358979, expected = 1.5 / kernel * std::sqrt(kernel / 100);
  const LadderChoice choice = best_choice(summary);
  CHECK(choice.level == 0);
  CHECK(choice.error95 == Approx(1.1 * expected));
  CHECK(best_choice(expected_with(summary, 4)).error95 == Approx(1.1 * expected / 4));
  // One dark sample of 400 hides no more than its own share.
  for (LadderLevel& level : dark)
    for (SetFields* fields : {&level.second, &level.fourth})
      for (auto& field : *fields) std::fill(field.begin() + 1, field.end(), 1.0);
  CHECK(best_choice(summary_of(dark, true, {}, photons)).error95 == Approx(1.1 * 1.5 / kernel / 20));
}
