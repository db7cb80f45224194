#include "design/field_figures.h"

#include <boost/math/special_functions/erf.hpp>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/random_stream.h"
#include "design/scene.h"
#include "support/statistics.h"

// Replicates with noise whose size is known, so that the figures' noise can be held against it.

using namespace catoptric;
using namespace catoptric::design;
using namespace catoptric::test;

namespace {

constexpr std::size_t samples = 64, replicates = 8;
constexpr double sigma = 0.02;

Scene scene() {
  const std::string text =
      "[source]\nposition = [0, 0, 5]\npower = 1\n[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n"
      "[near_field]\nradius = 8\nsamples = 64\n";
  return make_scene(Settings::parse(text, "s.toml", scene_keys()));
}

/// Falls from 3 to 1, and its least and greatest stand out by 10 sigma, so that noise does not choose others.
std::vector<double> truth() {
  std::vector<double> field;
  for (std::size_t i = 0; i < samples; ++i) field.push_back(2.5 - static_cast<double>(i) / samples);
  field.front() = 3;
  field.back() = 1;
  return field;
}

/// Independent normal noise on every sample of every replicate.
Rows replicated(std::uint64_t trial) {
  RandomStream random(11, Purpose::test, trial);
  Rows rows;
  for (std::size_t i = 0; i < replicates; ++i) {
    rows.push_back(truth());
    for (double& each : rows.back())
      each += sigma * std::sqrt(2.0) * boost::math::erf_inv(2 * random.uniform() - 1);
  }
  return rows;
}

/// Of many trials: errors over the noise that is known, noise as stated over it, and intervals that held.
struct Trials {
  double squares = 0, variances = 0;
  std::size_t held = 0, held_by_third = 0, count = 0;

  void add(const Figure& figure, double exact, double known_noise) {
    const double off = figure.value - figure.bias - exact;
    squares += off * off / (known_noise * known_noise);
    variances += figure.noise * figure.noise / (known_noise * known_noise);
    held += std::abs(off) <= *figure.half_interval;
    held_by_third += std::abs(off) <= *figure.half_interval / 3;
    ++count;
  }

  void check() const {
    CHECK(plausible(chi_square_tail(squares, count)));
    CHECK(plausible(variance_ratio_p(variances / static_cast<double>(count), count * (replicates - 1))));
    CHECK(plausible(binomial_p(held, count, 0.95)));
    // wrong twins: the noise of one replicate, and intervals of a third
    const double of_one = variances * static_cast<double>(replicates);
    CHECK(rejected(variance_ratio_p(of_one / static_cast<double>(count), count * (replicates - 1))));
    CHECK(rejected(binomial_p(held_by_third, count, 0.95)));
  }
};

}  // namespace

TEST_CASE("figures of a replicated noisy field carry the noise that it has") {
  const Scene spec = scene();
  const std::vector<sim::FieldSample> places = spec.near_field.samples(samples);
  const std::vector<double> field = truth(), dark(samples, 0.0);
  double average = 0, first = 0;
  for (const double each : field) average += each / samples;
  constexpr std::size_t innermost = samples / 16;  // of the inner of four rings, where the spiral begins
  for (std::size_t i = 0; i < innermost; ++i) first += field[i] / innermost;
  const double area = spec.near_field.area_mm2(), n = replicates;
  Trials averages, least, greatest, flux, uniformity, diversity, ring;
  for (std::uint64_t trial = 0; trial < 400; ++trial) {
    const Rows rows = replicated(trial);
    const FieldFigures found = field_figures(spec, places, dark, rows, rows);
    averages.add(found.average_w_per_mm2, average, sigma / std::sqrt(n * samples));
    least.add(found.least_w_per_mm2, 1, sigma / std::sqrt(n));
    greatest.add(found.greatest_w_per_mm2, 3, sigma / std::sqrt(n));
    flux.add(*found.flux_w, average * area, area * sigma / std::sqrt(n * samples));
    // of a ratio to first order: U0 = least / average, whose errors are one in 64 the same
    const double u0 = 1 / average, share = 1.0 / samples;
    uniformity.add(
        found.uniformity, u0,
        u0 * sigma / std::sqrt(n) * std::sqrt(1 + share / (average * average) - 2 * share / average));
    diversity.add(found.diversity, 1 / 3.0, sigma / std::sqrt(n) * std::sqrt(1 + 1 / 9.0) / 3);
    REQUIRE(found.zones.size() == 4);
    REQUIRE(found.zones[0].samples == innermost);
    ring.add(found.zones[0].irradiance_w_per_mm2, first, sigma / std::sqrt(n * innermost));
  }
  for (const Trials* each : {&averages, &least, &greatest, &flux, &uniformity, &diversity, &ring})
    each->check();
}

TEST_CASE("noise makes extremes more extreme, and the bias says by how much") {
  // an even field: each replicate's least is some 2.4 sigma too low, that of the mean by sqrt(8) less
  const Scene spec = scene();
  const std::vector<sim::FieldSample> places = spec.near_field.samples(samples);
  const std::vector<double> dark(samples, 0.0);
  double value = 0, cleaned = 0;
  constexpr int trials = 200;
  int held = 0, held_without_margin = 0;
  for (std::uint64_t trial = 0; trial < trials; ++trial) {
    Rows rows = replicated(trial);
    for (auto& row : rows)
      for (std::size_t i = 0; i < samples; ++i) row[i] += 1 - truth()[i];
    const Figure least = field_figures(spec, places, dark, rows, rows).least_w_per_mm2;
    value += (1 - least.value) / sigma / trials;
    cleaned += (1 - (least.value - least.bias)) / sigma / trials;
    const double off = std::abs(least.value - least.bias - 1);
    held += off <= *least.half_interval;
    held_without_margin += off <= *least.half_interval - extremes_margin(spread(rows)).least;
  }
  // expected least of 64 normal values: -2.3875 (Harter 1961, between 60 and 70)
  CHECK(value == Approx(2.39).epsilon(0.02));
  CHECK(cleaned == Approx(2.39 / std::sqrt(8.0)).epsilon(0.05));
  // where noise picks among alike places the interval has room for it, which it would miss else
  CHECK(held >= 0.95 * trials);
  CHECK(held_without_margin < 0.8 * trials);
}
