#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cad/engines.h"
#include "cad/meridian_reflector.h"
#include "support/cad/quadric.h"
#include "support/cad/rays.h"

/// First hits a second, one thread, by engine, part and ray class, asked one by one or in batches. Rates of
/// one run compare; the ratio of the engines is what a change may not spoil.

using namespace catoptric;
using namespace catoptric::test;

namespace {

/// Degree 3, nine spans, weights 0.75 to 1.25: what an import looks like.
Profile freeform() {
  std::vector<ControlPoint> points;
  for (int i = 0; i < 12; ++i) {
    const double r = 10.0 * i / 11;
    points.push_back({r, 10 - r * r / 20 + 0.1 * ((i * 7) % 5 - 2) * (i > 1), 1 + 0.25 * (i % 3 - 1)});
  }
  return Profile(3, Profile::uniform_knots(3, points.size()), points);
}

enum class Asked { one_by_one, in_batches };

/// Rays a second of the reference engine, by part and class; it runs first.
std::map<std::string, double> reference_rates;

std::vector<Ray> random_rays(const Reflector& reflector, RayClass which) {
  const std::size_t count = reflector.engine() == "occt" ? 500 : 100000;
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i)
    rays.push_back(random_ray(which, reflector.profile(), {0, 0, 5}, 1, i));
  return rays;
}

void trace(benchmark::State& state, const Reflector& reflector, RayClass which, Asked asked,
           const std::string& part) {
  const std::vector<Ray> rays = random_rays(reflector, which);
  std::vector<std::optional<Hit>> hits(rays.size());
  const auto probe = reflector.probe();
  const auto begin = std::chrono::steady_clock::now();
  for (auto _ : state)
    if (asked == Asked::in_batches)
      probe->first_hits(rays, 0, hits);
    else
      for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = probe->first_hit(rays[i], 0);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  const double count = static_cast<double>(state.iterations()) * static_cast<double>(rays.size());
  const auto met = std::count_if(hits.begin(), hits.end(), [](const auto& hit) { return hit.has_value(); });
  state.counters["rays"] = benchmark::Counter(count, benchmark::Counter::kIsRate);
  state.counters["hit_share"] = static_cast<double>(met) / static_cast<double>(rays.size());
  const double rate = count / seconds.count();
  if (reflector.engine() == "occt") reference_rates[part + name(which)] = rate;
  if (const auto found = reference_rates.find(part + name(which)); found != reference_rates.end())
    state.counters["times_occt"] = rate / found->second;
  if (const auto* meridian = dynamic_cast<const cad::MeridianProbe*>(probe.get())) {
    const auto& counts = meridian->counts();
    const double all = static_cast<double>(counts.rays);
    state.counters["halved_share"] = static_cast<double>(counts.halved) / all;
    state.counters["exact_share"] = static_cast<double>(counts.exact) / all;
    state.counters["side_by_side_share"] = static_cast<double>(counts.side_by_side) / all;
  }
}

void register_engine(const std::string& part, std::shared_ptr<Reflector> reflector, Asked asked) {
  const std::string how = asked == Asked::in_batches ? "_batch" : "";
  for (const RayClass which : all_classes)
    benchmark::RegisterBenchmark(
        (std::string(reflector->engine()) + how + "/" + part + "/" + name(which)).c_str(),
        [reflector, which, asked, part](benchmark::State& state) {
          trace(state, *reflector, which, asked, part);
        })
        ->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  const Profile paraboloid = Quadric::paraboloid().profile;
  for (const auto& [part, profile] :
       {std::pair{"paraboloid", paraboloid}, std::pair{"freeform", freeform()}}) {
    register_engine(part, cad::make_occt_reflector(profile), Asked::one_by_one);
    const std::shared_ptr<Reflector> meridian = cad::make_meridian_reflector(profile);
    register_engine(part, meridian, Asked::one_by_one);
    register_engine(part, meridian, Asked::in_batches);
    register_engine(part, cad::make_mesh_reflector(profile), Asked::one_by_one);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
