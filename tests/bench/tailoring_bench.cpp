#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <memory>

#include "base/random_stream.h"
#include "base/units.h"
#include "design/free_profile.h"
#include "design/scene.h"
#include "design/tailored_start.h"
#include "design/tailoring.h"
#include "sim/tubes.h"
#include "support/paper_tailoring.h"

/// What it costs to tailor a mirror, without a search of light: the paper's starts in its two variables; a
/// thousand random starts in its whole box; a hundred in all five variables that are no flat directions; and
/// mirrors made from nothing. The flux balance is set up anew each time.

using namespace catoptric;
using namespace catoptric::design;
using namespace catoptric::test;

namespace {

constexpr double a = paper_focus_mm, power_w = paper_power_w;

Profile bezier(double z0, double r1, double w1, double r2, double z2) {
  return Profile::bezier({{0, z0, 1}, {r1, z0, w1}, {r2, z2, 1}});
}

ProfileVariables all_variables(const Profile& base) {
  FreeProfileOptions options;
  options.r_greatest_mm = 400;
  options.z_least_mm = -50;
  options.z_greatest_mm = 300;
  const auto family = std::make_shared<FreeProfile>(base, options);
  return {family->variables(), [family](std::span<const double> x) { return family->at(x); },
          [family](const Profile& profile) { return family->chain(profile); }};
}

void start(benchmark::State& state, double w1, double r2_mm) {
  std::optional<Tailored> tailored;
  for (auto _ : state) {
    const FluxMap map = paper_map();
    tailored = tailor(map, paper_layout, RayMap::diverging, paper_variables(w1, r2_mm));
  }
  state.counters["evaluations"] = static_cast<double>(tailored->evaluations);
  state.counters["off_w1"] = std::abs(std::exp(tailored->values[0]) - 1);
  state.counters["off_r2"] = std::abs(tailored->values[1] / (2 * a) - 1);
}

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
  return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void random_starts(benchmark::State& state) {
  double slowest = 0, off = 0;
  int most_starts = 0;
  for (auto _ : state) {
    RandomStream random(7, Purpose::test, 0);
    for (int i = 0; i < 1000; ++i) {
      const double w1 = 0.05 + 19.95 * random.uniform(), r2_mm = 10 + 290 * random.uniform();
      const auto begin = std::chrono::steady_clock::now();
      const FluxMap map = paper_map();
      const Tailored tailored = tailor(map, paper_layout, RayMap::diverging, paper_variables(w1, r2_mm));
      slowest = std::max(slowest, milliseconds_since(begin));
      off = std::max(
          {off, std::abs(std::exp(tailored.values[0]) - 1), std::abs(tailored.values[1] / (2 * a) - 1)});
      most_starts = std::max(most_starts, tailored.starts);
    }
  }
  state.counters["slowest_ms"] = slowest;
  state.counters["greatest_off"] = off;
  state.counters["most_starts"] = most_starts;
}

/// Relative root mean square difference of the whole light from the paraboloid's on the paper's disc.
double light_off_rel(const Profile& profile) {
  std::vector<double> radii;
  for (double i = 0; i < 200; ++i) radii.push_back(50 * std::sqrt((i + 0.5) / 200));
  sim::TubesOptions options;
  options.kernel_radius_mm = 5;
  const sim::PointSource source({0, 0, a}, power_w);
  const auto light = sim::tubes_field(source, profile, {}, {0, true}, radii, options).irradiance;
  const auto wanted =
      sim::tubes_field(source, bezier(2 * a, a, 1, 2 * a, a), {}, {0, true}, radii, options).irradiance;
  double off = 0, all = 0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double direct = source.unhindered_w_per_mm2({radii[i], 0, 0}, {0, 0, 1});
    off += (light[i] - wanted[i]) * (light[i] - wanted[i]);
    all += (wanted[i] + direct) * (wanted[i] + direct);
  }
  return std::sqrt(off / all);
}

void five_variables(benchmark::State& state) {
  double slowest = 0, off = 0;
  for (auto _ : state) {
    RandomStream random(3, Purpose::test, 0);
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    for (int i = 0; i < 100; ++i) {
      const double z0 = between(60, 200), r1 = between(10, 150);
      const double w1 = std::exp(between(std::log(0.05), std::log(20))), r2 = between(20, 300);
      const Profile base = bezier(z0, r1, w1, r2, between(0, 90));
      const auto begin = std::chrono::steady_clock::now();
      const FluxMap map = paper_map();
      const Tailored tailored = tailor(map, paper_layout, RayMap::diverging, all_variables(base));
      slowest = std::max(slowest, milliseconds_since(begin));
      off = std::max(off, light_off_rel(tailored.profile));
    }
  }
  state.counters["slowest_ms"] = slowest;
  state.counters["greatest_light_off_rel"] = off;
}

void from_nothing(benchmark::State& state, const char* scene_file) {
  // Read once with the mirror made, then made again from the same wishes.
  Settings settings = Settings::read(std::string(CATOPTRIC_DATA) + scene_file, scene_keys());
  for (auto _ : state) benchmark::DoNotOptimize(make_scene(settings).profile.r_max_mm());
}

BENCHMARK_CAPTURE(start, A, 1.6, 90.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(start, B, 1.8, 70.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(start, C, std::sqrt(0.5), 50.0)->Unit(benchmark::kMillisecond);
BENCHMARK(random_starts)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(five_variables)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(from_nothing, uniform_disc, "/examples/uniform_disc.toml")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(from_nothing, ring, "/examples/ring.toml")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(from_nothing, gaussian_spot, "/examples/gaussian_spot.toml")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(from_nothing, two_zones, "/examples/two_zones.toml")->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
