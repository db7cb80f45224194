#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "cad/engines.h"
#include "sim/rings.h"
#include "sim/simulation.h"
#include "sim/tubes.h"

/// Time to an RMSE of 0.0034 W/m^2 on the paper's scene, by rung: the paraboloid with its focus in the
/// source, 512 samples on the disc of 5 cm, against eq. 12 and 13; one thread. The count of photons or rays
/// is doubled until the RMSE (root of its mean square over the streams) is below, then that one is timed. The
/// direct light is the same closed form in all rungs, so the reflected light's error is the whole error.

using namespace catoptric;

namespace {

constexpr double wanted_w_per_m2 = 0.0034;
constexpr double power_w = pi / 100;
constexpr double kernel_radius_mm = 5;  // as in the scene's file: its bias is 0.0012 W/m^2

/// @from paper eq. 12
double reflected(const sim::FieldSample& sample) {
  const double t = 1 + sample.point_mm.head<2>().squaredNorm() / 10'000;
  return power_w / (4 * pi * 2500 * t * t);
}

struct Setting {
  std::unique_ptr<Reflector> mirror =
      cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}));
  sim::PointSource source{{0, 0, 50}, power_w};
  sim::NearField field = sim::NearField::disc({0, 0, 0}, {0, 0, 1}, 50);
  sim::Scene scene{source, *mirror, {}, field};
  std::vector<sim::FieldSample> samples = field.samples(512);
  std::vector<double> radii_mm;
  Setting() {
    for (const auto& sample : samples) radii_mm.push_back(sample.point_mm.head<2>().norm());
  }

  double mean_square_error(const std::vector<double>& got) const {
    double sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
      sum += std::pow(to_w_per_m2(got[i] - reflected(samples[i])), 2);
    return sum / static_cast<double>(samples.size());
  }
};

std::vector<double> by_photons(const Setting& at, std::uint64_t count, std::uint64_t stream,
                               sim::Sampler sampler) {
  sim::PhotonOptions options;
  options.photons = count;
  options.stream = stream;
  options.sampler = sampler;
  sim::EstimateOptions estimate;
  estimate.kernel_radius_mm = kernel_radius_mm;
  const auto traced = sim::trace_photons(at.scene, options, sim::recording_margin_mm(at.field, estimate));
  return sim::PhotonMap(at.field, traced).estimate(at.samples, estimate).irradiance;
}

std::vector<double> by_rings(const Setting& at, std::uint64_t count, std::uint64_t stream) {
  sim::RingsOptions options;
  options.photons.photons = count;
  options.photons.stream = stream;
  options.photons.sampler = sim::Sampler::sobol;
  return sim::rings_field(at.scene, at.radii_mm, options).irradiance;
}

/// Smoothed as the photons' estimate is, to the tolerance that is wanted; it takes the rays it needs, at most
/// `count`.
std::vector<double> by_tubes(const Setting& at, std::uint64_t count) {
  sim::TubesOptions options;
  options.kernel_radius_mm = kernel_radius_mm;
  options.tolerance_w_per_mm2 = from_w_per_m2(wanted_w_per_m2);
  options.most_rays = static_cast<int>(count);
  return sim::tubes_field(at.scene, at.samples, options).irradiance;
}

struct Found {
  std::uint64_t count = 0;  ///< 0: none
  double rmse = HUGE_VAL;
};

/// The least power of two whose RMSE is below the wanted one.
template <typename Compute>
Found find_count(const Setting& at, const Compute& compute) {
  constexpr std::uint64_t first = 128, last = 1 << 27;
  for (std::uint64_t count = first; count <= last; count *= 2) {
    // 512 samples average over one stream already; few streams do where each takes seconds.
    const std::uint64_t streams = std::clamp<std::uint64_t>((1 << 21) / count, 2, 16);
    double sum = 0;
    for (std::uint64_t stream = 0; stream < streams; ++stream)
      sum += at.mean_square_error(compute(at, count, stream));
    const double rmse = std::sqrt(sum / static_cast<double>(streams));
    if (rmse <= wanted_w_per_m2) return {count, rmse};
  }
  return {};
}

/// @in  compute  field from a count and a stream
template <typename Compute>
void time_to_error(benchmark::State& state, const Compute& compute) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const Setting at;
  // Once for each rung: the library calls a benchmark again for each guess of its number of iterations.
  static const Found found = find_count(at, compute);
  if (found.count == 0) {
    state.SkipWithError("no count reaches the error that is wanted");
    return;
  }
  std::uint64_t stream = 100;  // none of those that chose the count
  for (auto _ : state) benchmark::DoNotOptimize(compute(at, found.count, stream++));
  state.counters["count"] = static_cast<double>(found.count);
  state.counters["rmse"] = found.rmse;
}

void tubes(benchmark::State& state) {
  time_to_error(state,
                [](const Setting& at, std::uint64_t count, std::uint64_t) { return by_tubes(at, count); });
}
void rings(benchmark::State& state) {
  time_to_error(state, [](const Setting& at, std::uint64_t count, std::uint64_t stream) {
    return by_rings(at, count, stream);
  });
}
void photons_sobol(benchmark::State& state) {
  time_to_error(state, [](const Setting& at, std::uint64_t count, std::uint64_t stream) {
    return by_photons(at, count, stream, sim::Sampler::sobol);
  });
}
void photons_random(benchmark::State& state) {
  time_to_error(state, [](const Setting& at, std::uint64_t count, std::uint64_t stream) {
    return by_photons(at, count, stream, sim::Sampler::random);
  });
}

BENCHMARK(tubes)->UseRealTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(rings)->UseRealTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(photons_sobol)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(photons_random)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
