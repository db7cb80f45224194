#include "sim/rings.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/units.h"
#include "cad/engines.h"
#include "sim/ring_counts.h"
#include "sim/ring_store.h"
#include "support/analytic_reflectors.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const auto mirror = test::paraboloid();
const PointSource source({0, 0, 50}, 1);
const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
const std::vector<double> radii{0, 30, 60, 99};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

std::string objection(const Vector3& place, const NearField& patch) {
  const PointSource at(place, 1);
  return rings_objection({at, mirror, {}, patch}).value_or("");
}

}  // namespace

TEST_CASE("rings object in words to what is not the same in all azimuths") {
  const Vector3 up(0, 0, 1), axis(0, 0, 50);
  CHECK(objection(axis, field).empty());
  CHECK(objection(axis, NearField::rectangle({30, 0, 0}, up, {1, 0, 0}, 10, 20)).empty());
  CHECK(objection(axis, NearField::disc({0, 0, 0}, -up, 10, Material::matt(0.5))).empty());
  CHECK_THAT(objection({1, 0, 50}, field), Catch::Contains("source is 1 mm off the axis"));
  CHECK_THAT(objection(axis, NearField::disc({0, 0, 0}, {0, 1, 1}, 10)),
             Catch::Contains("tilted by 45 degrees"));
  CHECK_THAT(objection(axis, NearField::disc({3, 4, 0}, up, 10, Material::matt(0))),
             Catch::Contains("5 mm off"));
  CHECK_THAT(objection(axis, NearField::rectangle({0, 0, 0}, up, {1, 0, 0}, 10, 20, Material::matt(0))),
             Catch::Contains("real rectangle"));
  const PointSource aside({1, 0, 50}, 1);
  CHECK_THROWS_AS(rings_field({aside, mirror, {}, field}, radii, {}), InputError);
}

TEST_CASE("rings refuse numbers that mean nothing") {
  const Scene scene{source, mirror, {}, field};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double radius : {-1.0, 101.0, nan})
    CHECK_THROWS_AS(rings_field(scene, std::vector<double>{radius}, {}), InputError);
  for (double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    RingsOptions options;
    options.bandwidth_mm2 = bad;
    CHECK_THROWS_AS(rings_field(scene, radii, options), InputError);
    options = {};
    options.edges_mm = {bad};
    CHECK_THROWS_AS(rings_field(scene, radii, options), InputError);
  }
  RingsOptions options;
  options.replicates = 0;
  CHECK_THROWS_AS(rings_field(scene, radii, options), InputError);
}

TEST_CASE("rings: no photon is dark, one photon is finite, fewer photons than replicates are shared out") {
  for (RingStorage storage : {RingStorage::counted, RingStorage::sorted})
    for (std::uint64_t photons : {0, 1, 2, 3, 7}) {
      RingsOptions options;
      options.storage = storage;
      options.photons.photons = photons;
      const auto got = rings_field({source, mirror, {}, field}, radii, options);
      CHECK(got.counts.emitted == photons);
      CHECK(got.replicates == std::min<std::uint64_t>(photons, options.replicates));
      CHECK(got.bandwidth_mm2 > 0);
      for (std::size_t i = 0; i < radii.size(); ++i) {
        CHECK(std::isfinite(got.irradiance[i]));
        CHECK(got.irradiance[i] >= 0);
        CHECK(std::isfinite(got.half_interval(i, 0.95)));
        if (photons == 0) CHECK(got.irradiance[i] == 0);
      }
    }
  CHECK(rings_field({source, mirror, {}, field}, {}, {}).irradiance.empty());
}

TEST_CASE("rings: 1, 2 and 7 threads give the same bits, in plane and in space, counted and sorted",
          "[threads]") {
  const auto meridian = cad::make_meridian_reflector(mirror.profile());
  for (bool in_plane : {true, false})
    for (RingStorage storage : {RingStorage::counted, RingStorage::sorted})
      for (Sampler sampler : {Sampler::random, Sampler::sobol}) {
        RingsOptions options;
        options.photons = {30'001, sampler, 3, 4, 50};
        options.storage = storage;
        options.in_plane = in_plane;
        const auto run = [&](int threads) {
          tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
          tbb::task_arena arena(threads);
          std::vector<double> numbers;
          arena.execute([&] {
            const auto got = rings_field({source, *meridian, {0.7, 0.1}, field}, radii, options);
            for (const auto* part : {&got.irradiance, &got.noise, &got.poisson_noise, &got.bias,
                                     &got.debiased, &got.debiased_noise})
              numbers.insert(numbers.end(), part->begin(), part->end());
            numbers.push_back(got.bandwidth_mm2);
            numbers.push_back(got.energy.received_w);
          });
          return numbers;
        };
        const auto one = run(1);
        CHECK(same_bits(one, run(2)));
        CHECK(same_bits(one, run(7)));
        options.photons.stream = 5;
        CHECK_FALSE(same_bits(one, run(2)));
      }
}

TEST_CASE("boundary kernels see straight lines and cubics exactly, anywhere in the window") {
  for (RingKernel kernel : {RingKernel::epanechnikov, RingKernel::biweight})
    for (double low : {-1.0, -0.7, -0.2, 0.0})
      for (double high : {1.0, 0.6, 0.3}) {
        const RingMoments moments = moments_between(kernel, low, high);
        for (int order : {2, 4}) {
          const BoundaryPolynomial polynomial = boundary_polynomial(moments, order);
          for (int power = 0; power < order; ++power) {
            double mean = 0;
            constexpr int steps = 20'000;  // midpoint rule, error below 1e-8 times the polynomial's size
            for (int i = 0; i < steps; ++i) {
              const double u = low + (high - low) * (i + 0.5) / steps;
              mean += (high - low) / steps * polynomial(u) * ring_kernel(kernel, u) * std::pow(u, power);
            }
            CHECK(mean == Approx(power == 0 ? 1 : 0).margin(1e-5));
          }
        }
      }
}

TEST_CASE("an even density with a jump reads even on both sides of it, up to it") {
  const std::vector<std::uint64_t> chunks{1};
  std::vector<double> squares;
  for (int i = 0; i < 40'000; ++i) squares.push_back((i + 0.5) / 400);        // 400 per mm^2 to 100
  for (int i = 0; i < 10'000; ++i) squares.push_back(100 + (i + 0.5) / 200);  // 200 to 150
  SortedRings sorted({0, 100, 150}, 1, chunks);
  CountedRings counted({0, 100, 150}, 1, 8192);
  for (RingStore* store : {static_cast<RingStore*>(&sorted), static_cast<RingStore*>(&counted)}) {
    store->add(0, 0, squares);
    store->close();
    const std::vector<double> places{0, 1e-9, 7, 50, 99.999, 100, 100.001, 125, 150};
    for (RingKernel kernel : {RingKernel::epanechnikov, RingKernel::biweight}) {
      std::vector<RingDensity> got(places.size());
      store->estimate(places, kernel, 20, [&](std::size_t i, const RingDensity& at) { got[i] = at; });
      for (std::size_t i = 0; i < places.size(); ++i) {
        // Photons stand evenly: their sum is the integral but for the kernel's jump at a cut, K / (h n) =
        // 1e-4. Bins: a photon may stand on either side of a bin's edge, 1 of 1250.
        CHECK(got[i].second_order[0] == Approx(places[i] < 100 ? 400 : 200).epsilon(2e-3));
        CHECK(got[i].fourth_order[0] == Approx(places[i] < 100 ? 400 : 200).epsilon(4e-3));
      }
    }
  }
}
