#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>

#include "base/units.h"
#include "cad/engines.h"
#include "sim/rings.h"

/// Rung "rings" on the paper's paraboloid, disc of radius 100 mm with the beam's sharp rim on its edge: time
/// and RMSE of 1024 estimates, from photons to field. Arguments: photons, threads, Sobol points or random,
/// in the plane or in space. W/m^2.

using namespace catoptric;

namespace {

constexpr double power_w = pi / 100;

double eq12(double r) {
  const double t = 1 + r * r / 10'000;
  return power_w / (4 * pi * 2500 * t * t);
}

void rings(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(state.range(1)));
  const auto mirror =
      cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}));
  const sim::PointSource source({0, 0, 50}, power_w);
  const auto field = sim::NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  std::vector<double> radii;
  for (const sim::FieldSample& sample : field.samples(1024))
    radii.push_back(sample.point_mm.head<2>().norm());
  sim::RingsOptions options;
  options.photons.photons = static_cast<std::uint64_t>(state.range(0));
  options.photons.sampler = state.range(2) != 0 ? sim::Sampler::sobol : sim::Sampler::random;
  options.in_plane = state.range(3) != 0;
  double sum = 0, bandwidth = 0, memory = 0;
  for (auto _ : state) {
    const auto got = sim::rings_field({source, *mirror, {}, field}, radii, options);
    state.PauseTiming();
    for (std::size_t i = 0; i < radii.size(); ++i)
      sum += std::pow(to_w_per_m2(got.irradiance[i] - eq12(radii[i])), 2);
    bandwidth = got.bandwidth_mm2;
    memory = static_cast<double>(got.memory_bytes);
    ++options.photons.stream;
    state.ResumeTiming();
  }
  state.counters["rmse"] = std::sqrt(sum / static_cast<double>(radii.size() * state.iterations()));
  state.counters["bandwidth_mm2"] = bandwidth;
  state.counters["bytes"] = memory;
}

BENCHMARK(rings)
    ->ArgNames({"photons", "threads", "sobol", "plane"})
    ->Args({1'000, 1, 1, 1})
    ->Args({2'500, 1, 1, 1})
    ->Args({10'000, 1, 1, 1})
    ->Args({10'000, 2, 1, 1})
    ->Args({10'000, 1, 0, 1})
    ->Args({10'000, 1, 1, 0})
    ->Args({1'000'000, 1, 1, 1})
    ->Args({1'000'000, 2, 1, 1})
    ->Args({1'000'000, 1, 0, 1})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
