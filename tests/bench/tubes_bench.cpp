#include <benchmark/benchmark.h>

#include <cmath>

#include "base/units.h"
#include "sim/tubes.h"
#include "sim/tubes_jacobian.h"

/// What an evaluation by ray tubes costs on the paper's paraboloid and starts: 512 distinct radii on the disc
/// of 5 cm, kernel radius 5 mm, to 1e-6 W/m^2; at 64 radii, where the rays themselves weigh more; pointwise
/// at 1024 radii, and on a
/// square of 32 x 32 samples (0), to 5e-7 W/m^2; and with the derivatives by all nine coordinates and
/// weights.

using namespace catoptric;

namespace {

const sim::PointSource source({0, 0, 50}, pi / 100);

Profile mirror(double w1, double x2_mm) {
  return Profile::bezier({{0, 100, 1}, {50, 100, w1}, {x2_mm, 50, 1}});
}

std::vector<double> radii_of(const benchmark::State& state) {
  std::vector<double> radii;
  const auto count = static_cast<double>(state.range(0));
  for (double i = 0; i < count; ++i) radii.push_back(50 * std::sqrt((i + 0.5) / count));
  return radii;
}

void report(benchmark::State& state, const sim::TubesField& field) {
  state.counters["rays"] = field.rays;
  state.counters["error_w_per_m2"] = to_w_per_m2(field.error_w_per_mm2);
}

void smoothed(benchmark::State& state, double w1, double x2_mm) {
  const Profile profile = mirror(w1, x2_mm);
  const std::vector<double> radii = radii_of(state);
  sim::TubesOptions options;
  options.kernel_radius_mm = 5;
  sim::TubesField field;
  for (auto _ : state) {
    field = sim::tubes_field(source, profile, {}, {0, true}, radii, options);
    benchmark::DoNotOptimize(field.irradiance.data());
  }
  report(state, field);
}

/// Of 32 x 32 samples over the whole beam, many of them alike.
std::vector<double> grid_radii() {
  std::vector<double> radii;
  for (double i = -15.5; i < 16; ++i)
    for (double j = -15.5; j < 16; ++j) radii.push_back(6.25 * std::hypot(i, j));
  return radii;
}

void pointwise(benchmark::State& state, double w1, double x2_mm) {
  const Profile profile = mirror(w1, x2_mm);
  const std::vector<double> radii = state.range(0) > 0 ? radii_of(state) : grid_radii();
  sim::TubesOptions options;
  options.pointwise_tolerance_w_per_mm2 = from_w_per_m2(5e-7);
  sim::TubesField field;
  for (auto _ : state) {
    field = sim::tubes_field(source, profile, {}, {0, true}, radii, options);
    benchmark::DoNotOptimize(field.irradiance.data());
  }
  report(state, field);
}

void jacobian(benchmark::State& state, double w1, double x2_mm) {
  const Profile profile = mirror(w1, x2_mm);
  const std::vector<double> radii = radii_of(state);
  sim::TubesOptions options;
  options.kernel_radius_mm = 5;
  sim::TubesJacobian result;
  for (auto _ : state) {
    result = sim::tubes_jacobian(source, profile, {}, {0, true}, radii, options);
    benchmark::DoNotOptimize(result.by_variable.data());
  }
  report(state, result.field);
}

BENCHMARK_CAPTURE(smoothed, paraboloid, 1.0, 100.0)->Arg(64)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(smoothed, start_a, 1.6, 90.0)->Arg(64)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(smoothed, start_b, 1.8, 70.0)->Arg(64)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(smoothed, start_c, std::sqrt(0.5), 50.0)->Arg(64)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pointwise, paraboloid, 1.0, 100.0)->Arg(1024)->Arg(0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(pointwise, start_a, 1.6, 90.0)->Arg(1024)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(jacobian, paraboloid, 1.0, 100.0)->Arg(512)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(jacobian, start_a, 1.6, 90.0)->Arg(512)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
