#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "base/units.h"
#include "sim/accuracy.h"
#include "sim/simulation.h"
#include "support/analytic_reflectors.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

std::vector<double> all_numbers(const FieldEstimate& got) {
  std::vector<double> numbers;
  for (const auto* part : {&got.direct, &got.reflected, &got.noise, &got.kernel_radius_mm})
    numbers.insert(numbers.end(), part->begin(), part->end());
  const EnergyLedger& energy = got.energy;
  for (double each : {energy.emitted_w, energy.missed_w, energy.absorbed_w, energy.received_w,
                      energy.escaped_w, energy.cut_off_w})
    numbers.push_back(each);
  for (std::uint64_t each :
       {got.counts.emitted, got.counts.met_mirror, got.counts.stored, got.counts.interactions})
    numbers.push_back(static_cast<double>(each));
  return numbers;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

template <typename Run>
std::vector<double> with_threads(int threads, const Run& run) {
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  std::vector<double> numbers;
  arena.execute([&] { numbers = run(); });
  return numbers;
}

}  // namespace

TEST_CASE("1, 2 and 7 threads give the same bits", "[threads]") {
  const auto mirror = test::half_ellipsoid(50, 50, 80);
  const PointSource source({5, 0, 60}, 1);
  for (const auto& material :
       {std::optional<Material>{}, std::optional<Material>{Material::matt(0.5, 0.2)}}) {
    const auto field = NearField::rectangle({0, 0, 0}, {0.1, 0, 1}, {1, 0, 0}, 150, 100, material);
    const Material surface = material ? Material{0.5, 0.1, 0.2, 0.3} : Material{0.7, 0.1};
    const auto samples = field.samples(333);
    for (Sampler sampler : {Sampler::random, Sampler::sobol})
      for (const EstimateOptions& estimate :
           {EstimateOptions{Kernel::silverman, 100, {}}, EstimateOptions{Kernel::cone, {}, 9.0}}) {
        const auto run = [&] {
          const PhotonOptions options{20'001, sampler, 3, 4, 50};
          return all_numbers(simulate({source, mirror, surface, field}, samples, options, estimate));
        };
        const auto one = with_threads(1, run);
        CHECK(same_bits(one, with_threads(2, run)));
        CHECK(same_bits(one, with_threads(7, run)));
        const auto other = all_numbers(
            simulate({source, mirror, surface, field}, samples, {20'001, sampler, 3, 5, 50}, estimate));
        CHECK_FALSE(same_bits(one, other));  // another stream is another set
      }
  }
}

TEST_CASE("an accuracy is reached with the same bits by 1, 2 and 7 threads", "[threads]") {
  const auto mirror = test::half_ellipsoid(50, 50, 80);
  const PointSource source({5, 0, 60}, 1);
  const auto field = NearField::rectangle({0, 0, 0}, {0.1, 0, 1}, {1, 0, 0}, 150, 100);
  const auto samples = field.samples(333);
  AccuracyRequest request;
  request.relative = 0.05;
  request.most_photons = 200'000;
  const auto run = [&] {
    const AccurateField got = reach_accuracy({source, mirror, {0.7, 0.1}, field}, samples, request);
    std::vector<double> numbers = got.reflected;
    numbers.insert(numbers.end(), got.noise.begin(), got.noise.end());
    for (const AccuracyStage& stage : got.stages) numbers.push_back(stage.error95_rel);
    for (const double each : {got.kernel_radius_mm, got.energy.received_w, got.energy.emitted_w})
      numbers.push_back(each);
    CHECK(got.stages.size() > 1);  // sets of several stages
    return numbers;
  };
  const auto one = with_threads(1, run);
  CHECK(same_bits(one, with_threads(2, run)));
  CHECK(same_bits(one, with_threads(7, run)));
  request.photons.stream = 77;
  CHECK_FALSE(same_bits(one, with_threads(2, run)));
}

TEST_CASE("the ledger adds up whatever the scene does") {
  const auto mirror = test::half_ellipsoid(50, 50, 80);
  for (const Vector3& place : {Vector3(0, 0, 50), Vector3(5, 0, 60), Vector3(0, 0, -300), Vector3(90, 0, 70)})
    for (const Material& surface :
         {Material{1, 0}, Material{0.7, 0.2}, Material{0, 0}, Material::metal(1.1, 6.6),
          Material{0.5, 0.1, 0.3, 0.2}, Material::matt(0.8)})
      for (const auto& material :
           {std::optional<Material>{}, std::optional<Material>{Material::matt(0.5, 0.2)}}) {
        const auto field = NearField::disc({0, 0, 20}, {0, 0, 1}, 40, material);
        const PointSource source(place, 3.7);
        const auto traced =
            trace_photons({source, mirror, surface, field}, {3000, Sampler::random, 1, 0, 20}, 0);
        const EnergyLedger& energy = traced.energy;
        const double sum =
            energy.missed_w + energy.absorbed_w + energy.received_w + energy.escaped_w + energy.cut_off_w;
        CHECK(std::abs(sum - energy.emitted_w) <= 1e-12 * energy.emitted_w);
        CHECK(energy.emitted_w <= 3.7 * (1 + 1e-12));
      }
}

TEST_CASE("the scene a thousand times smaller or larger gives the same irradiance times its square") {
  const auto run = [](double scale) {
    const auto mirror = test::paraboloid(50 * scale);
    const PointSource source({4 * scale, 0, 55 * scale}, 1);
    const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 60 * scale);
    const EstimateOptions estimate{Kernel::silverman, {}, 9 * scale};
    auto got = simulate({source, mirror, {0.8, 0}, field}, field.samples(100),
                        {20'000, Sampler::random, 1, 0, 1000}, estimate);
    for (auto* part : {&got.reflected, &got.direct})
      for (double& each : *part) each *= scale * scale;
    return got;
  };
  const auto plain = run(1);
  for (double scale : {1e-3, 1e3}) {
    const auto scaled = run(scale);
    CHECK(scaled.counts.stored == plain.counts.stored);
    CHECK(scaled.counts.interactions == plain.counts.interactions);
    for (std::size_t i = 0; i < plain.reflected.size(); ++i) {
      // rounding only: a photon's weight changes by some 1e-14 times the kernel's slope
      CHECK(scaled.reflected[i] == Approx(plain.reflected[i]).epsilon(1e-11));
      CHECK(scaled.direct[i] == Approx(plain.direct[i]).epsilon(1e-13));
    }
  }
}
