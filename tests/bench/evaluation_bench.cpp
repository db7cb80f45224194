#include <benchmark/benchmark.h>
#include <malloc.h>
#include <tbb/global_control.h>

#include "cad/engines.h"
#include "design/evaluator.h"
#include "design/run.h"
#include "design/scene.h"
#include "sim/simulation.h"

/// What an evaluation of the objective costs, stage by stage, on the paper's start A: photons traced, points
/// put into the tree, estimates made, whole evaluations a second. The argument is the number of threads.

using namespace catoptric;

namespace {

const design::Scene& start_a() {
  static const design::Scene scene = design::read_scene(CATOPTRIC_DATA "/paper/start_a.toml");
  return scene;
}

/// Limits the threads of one benchmark.
tbb::global_control limit(const benchmark::State& state) {
  return {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(state.range(0))};
}

void rate(benchmark::State& state, const char* name, double count) {
  state.counters[name] =
      benchmark::Counter(static_cast<double>(state.iterations()) * count, benchmark::Counter::kIsRate);
}

struct Stage {
  sim::PointSource source{start_a().source.position_mm, start_a().source.power_w};
  std::unique_ptr<Reflector> mirror = cad::make_meridian_reflector(design::start_profile(start_a()));
  sim::Scene scene{source, *mirror, start_a().mirror, start_a().near_field};
  double margin_mm = sim::recording_margin_mm(start_a().near_field, start_a().model.estimate);
};

/// Bytes the program holds.
double bytes_held() {
  const struct mallinfo2 now = mallinfo2();
  return static_cast<double>(now.uordblks + now.hblkhd);
}

void trace(benchmark::State& state) {
  const auto threads = limit(state);
  const Stage stage;
  for (auto _ : state)
    benchmark::DoNotOptimize(sim::trace_photons(stage.scene, start_a().model.photons, stage.margin_mm));
  rate(state, "photons", static_cast<double>(start_a().model.photons.photons));
}

void tree(benchmark::State& state) {
  const auto threads = limit(state);
  const Stage stage;
  const auto photons = sim::trace_photons(stage.scene, start_a().model.photons, stage.margin_mm);
  for (auto _ : state) benchmark::DoNotOptimize(sim::PhotonMap(start_a().near_field, photons));
  const auto points = static_cast<double>(photons.crossings.size());
  rate(state, "points", points);
  const double before = bytes_held();
  const sim::PhotonMap map(start_a().near_field, photons);
  state.counters["bytes_per_point"] = (bytes_held() - before) / points;
  state.counters["bytes_per_crossing"] = sizeof(sim::Crossing);
}

void estimate(benchmark::State& state) {
  const auto threads = limit(state);
  const Stage stage;
  const auto photons = sim::trace_photons(stage.scene, start_a().model.photons, stage.margin_mm);
  const sim::PhotonMap map(start_a().near_field, photons);
  const auto samples = start_a().near_field.samples(start_a().samples);
  for (auto _ : state) benchmark::DoNotOptimize(map.estimate(samples, start_a().model.estimate));
  rate(state, "estimates", static_cast<double>(samples.size()));
}

void evaluation(benchmark::State& state) {
  const auto threads = limit(state);
  const Profile profile = design::start_profile(start_a());
  const design::Target target = design::make_target(start_a());
  for (auto _ : state) {
    const auto field = design::estimate_field(start_a(), profile, target.samples, 0);
    benchmark::DoNotOptimize(design::objective(start_a(), design::total(field), target.irradiance_w_per_mm2));
  }
  rate(state, "evaluations", 1);
}

BENCHMARK(trace)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(tree)->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(estimate)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(evaluation)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
