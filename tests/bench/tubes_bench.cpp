#include <benchmark/benchmark.h>

#include <cmath>

#include "base/units.h"
#include "sim/tubes.h"

/// What an evaluation by ray tubes costs on the paper's paraboloid and starts: 512 distinct radii on the disc
/// of 5 cm, kernel radius 5 mm, to 1e-6 W/m^2; and at 64 radii, where the rays themselves weigh more.

using namespace catoptric;

namespace {

void smoothed(benchmark::State& state, double w1, double x2_mm) {
  const sim::PointSource source({0, 0, 50}, pi / 100);
  const Profile profile = Profile::bezier({{0, 100, 1}, {50, 100, w1}, {x2_mm, 50, 1}});
  std::vector<double> radii;
  const auto count = static_cast<double>(state.range(0));
  for (double i = 0; i < count; ++i) radii.push_back(50 * std::sqrt((i + 0.5) / count));
  sim::TubesOptions options;
  options.kernel_radius_mm = 5;
  sim::TubesField field;
  for (auto _ : state) {
    field = sim::tubes_field(source, profile, {}, {0, true}, radii, options);
    benchmark::DoNotOptimize(field.irradiance.data());
  }
  state.counters["rays"] = field.rays;
  state.counters["error_w_per_m2"] = to_w_per_m2(field.error_w_per_mm2);
}

BENCHMARK_CAPTURE(smoothed, paraboloid, 1.0, 100.0)->Arg(64)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(smoothed, start_a, 1.6, 90.0)->Arg(64)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(smoothed, start_b, 1.8, 70.0)->Arg(64)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(smoothed, start_c, std::sqrt(0.5), 50.0)->Arg(64)->Arg(512)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
