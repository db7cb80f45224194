#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "design/evaluator.h"
#include "design/run.h"
#include "design/scene.h"
#include "design/stage.h"
#include "report/ray_report.h"
#include "sim/tracer.h"
#include "support/temporary_folder.h"

/// What each kind of source costs on the paper's paraboloid, 100,000 Sobol photons and 512 samples: an
/// evaluation by photons (direct light once more each time), one by the rung that a search takes, and flights
/// alone. The argument is the number of threads.

using namespace catoptric;

namespace {

constexpr double photons_of_a_set = 100'000;

/// The paper's paraboloid without its target, and a source in its focus.
design::Scene scene_with(const std::string& source) {
  return design::make_scene(design::Settings::parse(
      "unit = \"cm\"\nsource.position = [0, 0, 5]\n" + source +
          "\n[reflector]\ndegree = 2\npoints = [[0, 10], [5, 10], [10, 5]]\n"
          "[near_field]\nradius = 5\n[model]\nphotons = 100000\nkernel_radius = 0.5\n",
      "bench.toml", design::scene_keys()));
}

const std::string disc = "source.kind = \"disc\"\nsource.radius = 0.2\nsource.power = 0.03\n";

/// A table of intensities and a million rays of a disc, made anew for each run.
const std::filesystem::path& source_files() {
  static const test::TemporaryFolder folder;
  static const std::filesystem::path path = [] {
    std::ofstream(folder / "lamp.ies")
        << "IESNA:LM-63-2002\n[TEST] bench\n[TESTLAB] none\n[ISSUEDATE] none\n[MANUFAC] none\nTILT=NONE\n"
           "1 1000 1 5 1 1 2 0 0 0\n1 1 0\n0 22.5 45 67.5 90\n0\n320 300 230 120 0\n";
    report::write_rays(scene_with(disc), {}, folder.path());
    return folder.path();
  }();
  return path;
}

design::Scene scene_of(const std::string& kind) {
  const auto file = [](const char* name) {
    return "source.file = \"" + (source_files() / name).string() + "\"\nsource.power = 0.03\n";
  };
  if (kind == "point") return scene_with("source.power = 0.03\n");
  if (kind == "disc") return scene_with(disc);
  if (kind == "rectangle")
    return scene_with(
        "source.kind = \"rectangle\"\nsource.width = 0.3\nsource.height = 0.2\nsource.power = 0.03\n");
  if (kind == "sphere")
    return scene_with("source.kind = \"sphere\"\nsource.radius = 0.2\nsource.power = 0.03\n");
  if (kind == "cylinder")
    return scene_with(
        "source.kind = \"cylinder\"\nsource.radius = 0.1\nsource.length = 0.4\nsource.power = 0.03\n");
  if (kind == "intensity") return scene_with("source.kind = \"intensity\"\n" + file("lamp.ies"));
  if (kind == "rays") return scene_with("source.kind = \"rays\"\n" + file("source.tm25ray"));
  return scene_with(
      "[sources.chip]\nkind = \"rectangle\"\nwidth = 0.3\nheight = 0.2\npower = 0.02\n"
      "[sources.dome]\nkind = \"sphere\"\nradius = 0.25\npower = 0.01\n");
}

tbb::global_control limit(const benchmark::State& state) {
  return {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(state.range(0))};
}

void rate(benchmark::State& state, double count) {
  state.counters["photons"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * count, benchmark::Counter::kIsRate);
}

void evaluate(benchmark::State& state, const std::string& kind, bool by_photons) {
  const auto threads = limit(state);
  const design::Scene scene = scene_of(kind);
  const design::Candidate candidate = design::start_candidate(scene);
  const auto samples = scene.near_field.samples(scene.samples);
  const sim::Rung rung = by_photons ? sim::Rung::photons : design::simulation_plan(scene, candidate).rung;
  for (auto _ : state) benchmark::DoNotOptimize(design::total_by_rung(scene, rung, candidate, samples, 0));
  state.SetLabel(std::string(name(rung)));
  if (rung != sim::Rung::tubes) rate(state, photons_of_a_set);
}

void fly(benchmark::State& state, const std::string& kind) {
  const auto threads = limit(state);
  const design::Scene scene = scene_of(kind);
  const design::Stage stage(scene, design::start_candidate(scene));
  sim::PhotonOptions options = scene.model.photons;
  const sim::PhotonFlights flights(
      stage.scene, sim::RecordedArea::about(scene.near_field, scene.near_field.half_width_mm() * 0.1));
  for (auto _ : state)
    benchmark::DoNotOptimize(flights.fly(options, [](std::uint64_t, std::vector<sim::Crossing>&&) {}));
  rate(state, photons_of_a_set);
}

/// Rays of a disc to a file and back, checked.
void write(benchmark::State& state) {
  const auto threads = limit(state);
  const test::TemporaryFolder folder;
  const design::Scene scene = scene_of("disc");
  for (auto _ : state) report::write_rays(scene, {}, folder.path());
  rate(state, static_cast<double>(scene.rays.count));
}
BENCHMARK(write)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

const bool registered = [] {
  for (const char* kind :
       {"point", "disc", "rectangle", "sphere", "cylinder", "intensity", "rays", "group"}) {
    const std::string name = kind;
    const auto add = [](const std::string& title, auto&& run) {
      benchmark::RegisterBenchmark(title.c_str(), run)
          ->Arg(1)
          ->Arg(2)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    };
    add("by_photons/" + name, [name](benchmark::State& state) { evaluate(state, name, true); });
    add("by_plan/" + name, [name](benchmark::State& state) { evaluate(state, name, false); });
    add("flights/" + name, [name](benchmark::State& state) { fly(state, name); });
  }
  return true;
}();

}  // namespace

BENCHMARK_MAIN();
