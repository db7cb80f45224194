#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "cad/engines.h"
#include "cad/meridian_reflector.h"
#include "support/cad/quadric.h"
#include "support/cad/rays.h"

/// First hits a second, one thread, by engine, part and ray class. Rates of one run compare; the ratio of the
/// engines is what a change may not spoil.

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

void trace(benchmark::State& state, const Reflector& reflector, RayClass which) {
  const std::size_t count = reflector.engine() == "occt" ? 500 : 100000;
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i)
    rays.push_back(random_ray(which, reflector.profile(), {0, 0, 5}, 1, i));
  const auto probe = reflector.probe();
  std::size_t hits = 0;
  for (auto _ : state)
    for (const Ray& ray : rays) hits += probe->first_hit(ray, 0).has_value();
  const double asked = static_cast<double>(state.iterations()) * static_cast<double>(count);
  state.counters["rays"] = benchmark::Counter(asked, benchmark::Counter::kIsRate);
  state.counters["hit_share"] = static_cast<double>(hits) / asked;
  if (const auto* meridian = dynamic_cast<const cad::MeridianProbe*>(probe.get())) {
    const auto& counts = meridian->counts();
    state.counters["halved_share"] = static_cast<double>(counts.halved) / static_cast<double>(counts.rays);
    state.counters["exact_share"] = static_cast<double>(counts.exact) / static_cast<double>(counts.rays);
  }
}

void register_engine(const std::string& part, std::shared_ptr<Reflector> reflector) {
  for (const RayClass which : all_classes)
    benchmark::RegisterBenchmark(
        (std::string(reflector->engine()) + "/" + part + "/" + name(which)).c_str(),
        [reflector, which](benchmark::State& state) { trace(state, *reflector, which); })
        ->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  const Profile paraboloid = Quadric::paraboloid().profile;
  for (const auto& [part, profile] :
       {std::pair{"paraboloid", paraboloid}, std::pair{"freeform", freeform()}}) {
    register_engine(part, cad::make_meridian_reflector(profile));
    register_engine(part, cad::make_mesh_reflector(profile));
    register_engine(part, cad::make_occt_reflector(profile));
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
