#include <benchmark/benchmark.h>
#include <malloc.h>
#include <tbb/global_control.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "cad/engines.h"
#include "design/evaluator.h"
#include "design/run.h"
#include "design/scene.h"
#include "sim/simulation.h"

/// What an evaluation of the objective costs, stage by stage, on the paper's start A: photons traced (in
/// their meridian planes, and in space as other scenes need it), photons put into the map, estimates made,
/// whole photons from emission to deposit, whole evaluations a second. The first argument is the number of
/// threads.

using namespace catoptric;

namespace {

/// Bytes of all living objects, and the most there were at a time since it was last set.
std::atomic<std::size_t> bytes_now{0}, bytes_at_most{0};

void* counted(void* block) {
  if (block == nullptr) throw std::bad_alloc();
  const std::size_t now = bytes_now += malloc_usable_size(block);
  std::size_t most = bytes_at_most;
  while (now > most && !bytes_at_most.compare_exchange_weak(most, now)) {
  }
  return block;
}

void release(void* block) {
  bytes_now -= malloc_usable_size(block);
  std::free(block);
}

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(size)); }
void operator delete(void* block) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }

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

/// The scene's photons, as many as the second argument says.
sim::PhotonOptions photons(const benchmark::State& state) {
  sim::PhotonOptions options = start_a().model.photons;
  options.photons = static_cast<std::uint64_t>(state.range(1));
  return options;
}

void trace(benchmark::State& state) {
  const auto threads = limit(state);
  const Stage stage;
  const sim::PhotonOptions options = photons(state);
  for (auto _ : state) benchmark::DoNotOptimize(sim::trace_photons(stage.scene, options, stage.margin_mm));
  rate(state, "photons", static_cast<double>(options.photons));
}

void trace_in_space(benchmark::State& state) {
  const auto threads = limit(state);
  const Stage stage;
  const sim::PhotonOptions options = photons(state);
  const sim::PhotonFlights flights(stage.scene,
                                   sim::RecordedArea::about(start_a().near_field, stage.margin_mm),
                                   sim::FlightSpace::always_space);
  for (auto _ : state)
    benchmark::DoNotOptimize(flights.fly(options, [](std::uint64_t, std::vector<sim::Crossing>&&) {}));
  rate(state, "photons", static_cast<double>(options.photons));
}

void map(benchmark::State& state) {
  const auto threads = limit(state);
  const Stage stage;
  const auto traced = sim::trace_photons(stage.scene, photons(state), stage.margin_mm);
  for (auto _ : state) {
    state.PauseTiming();
    auto copy = traced;
    state.ResumeTiming();
    const sim::PhotonMap built(start_a().near_field, std::move(copy));
  }
  rate(state, "points", static_cast<double>(traced.counts.stored));
}

/// Emission to deposit in the map; memory at the worst moment of both, and of the map when it is done.
void whole_photons(benchmark::State& state) {
  const auto threads = limit(state);
  const Stage stage;
  const sim::PhotonOptions options = photons(state);
  std::size_t before = 0, after = 0;
  std::uint64_t stored = 0;
  for (auto _ : state) {
    before = bytes_now;
    bytes_at_most = before;
    sim::TracedPhotons traced = sim::trace_photons(stage.scene, options, stage.margin_mm);
    stored = traced.counts.stored;
    const sim::PhotonMap built(start_a().near_field, std::move(traced));
    after = bytes_now;
  }
  const auto a_photon = [&](std::size_t bytes) {
    return static_cast<double>(bytes - before) / static_cast<double>(stored);
  };
  state.counters["most_bytes_a_photon"] = a_photon(bytes_at_most);
  state.counters["bytes_a_photon"] = a_photon(after);
  rate(state, "photons", static_cast<double>(options.photons));
}

void estimate(benchmark::State& state, const sim::EstimateOptions& options) {
  const auto threads = limit(state);
  const Stage stage;
  const sim::PhotonMap built(start_a().near_field,
                             sim::trace_photons(stage.scene, photons(state), stage.margin_mm));
  const auto samples = start_a().near_field.samples(start_a().samples);
  for (auto _ : state) benchmark::DoNotOptimize(built.estimate(samples, options));
  rate(state, "estimates", static_cast<double>(samples.size()));
}

void evaluation(benchmark::State& state) {
  const auto threads = limit(state);
  const Profile profile = design::start_profile(start_a());
  const design::Target target = design::make_target(start_a());
  for (auto _ : state)
    benchmark::DoNotOptimize(
        design::total_by_rung(start_a(), sim::Rung::photons, profile, target.samples, 0));
  rate(state, "evaluations", 1);
}

void threads_and_photons(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"threads", "photons"})->UseRealTime()->Unit(benchmark::kMillisecond);
  for (const int photons : {100'000, 10'000'000})
    for (const int threads : {1, 2}) benchmark->Args({threads, photons});
}

BENCHMARK(trace)->Apply(threads_and_photons);
BENCHMARK(trace_in_space)->Apply(threads_and_photons);
BENCHMARK(map)->Apply(threads_and_photons);
BENCHMARK(whole_photons)->Apply(threads_and_photons);
BENCHMARK_CAPTURE(estimate, radius_5_mm, sim::EstimateOptions{sim::Kernel::silverman, {}, 5.0})
    ->Apply(threads_and_photons);
BENCHMARK_CAPTURE(estimate, nearest_400, sim::EstimateOptions{sim::Kernel::silverman, 400, {}})
    ->Apply(threads_and_photons);
BENCHMARK(evaluation)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
