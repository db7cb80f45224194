#include "sim/photon_fields.h"

#include <array>
#include <atomic>
#include <catch2/catch.hpp>

#include "base/errors.h"
#include "support/analytic_reflectors.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const auto mirror = test::paraboloid();
const PointSource source({10, 0, 50}, 40);
const auto field = NearField::rectangle({5, 0, 0}, Vector3(0.1, 0, 1).normalized(), {0, 1, 0}, 100, 80);
const Scene scene{source, mirror, {}, field};
const EstimateOptions wide{Kernel::silverman, {}, 8.0}, narrow{Kernel::epanechnikov, {}, 3.0},
    nearest{Kernel::silverman, 300, {}};

}  // namespace

TEST_CASE("photons summed batch by batch give what one map of all gives", "[threads]") {
  const auto samples = field.samples(200);
  for (const std::uint64_t count :
       {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1024}, std::uint64_t{50'001}}) {
    const PhotonOptions photons{count, Sampler::sobol, 3, 2, 1000};
    const std::array bandwidths{wide, narrow};
    const PhotonFields whole = photon_fields(scene, samples, photons, bandwidths);
    const PhotonFields batches = photon_fields(scene, samples, photons, bandwidths, 4 * photons_of_a_chunk);
    CAPTURE(count);
    CHECK(whole.counts.emitted == count);
    CHECK(batches.counts.stored == whole.counts.stored);
    CHECK(batches.energy.received_w == whole.energy.received_w);
    CHECK(batches.energy.emitted_w == whole.energy.emitted_w);
    for (std::size_t k = 0; k < bandwidths.size(); ++k)
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const MapEstimate &one = whole.estimates[k], &sum = batches.estimates[k];
        // some hundred photons a sample, added in another order
        CHECK(sum.irradiance[i] == Approx(one.irradiance[i]).epsilon(1e-13).margin(1e-300));
        CHECK(sum.noise[i] == Approx(one.noise[i]).epsilon(1e-13).margin(1e-300));
        CHECK(sum.photons[i] == one.photons[i]);
        CHECK(sum.kernel_radius_mm[i] == one.kernel_radius_mm[i]);
      }
    if (count > 1024) CHECK(whole.estimates[0].irradiance[100] > 0);
  }
}

TEST_CASE("one batch is one map, bit for bit, and the nearest N are never cut into batches") {
  const auto samples = field.samples(50);
  const PhotonOptions photons{30'000, Sampler::sobol, 3, 2, 1000};
  for (const EstimateOptions& bandwidth : {wide, nearest}) {
    const PhotonMap map(field, trace_photons(scene, photons, recording_margin_mm(field, bandwidth)));
    const MapEstimate expected = map.estimate(samples, bandwidth);
    const std::uint64_t batch = bandwidth.neighbours ? photons_of_a_chunk : photons_of_a_batch;
    const PhotonFields got = photon_fields(scene, samples, photons, std::array{bandwidth}, batch);
    CHECK(got.estimates[0].irradiance == expected.irradiance);
    CHECK(got.estimates[0].noise == expected.noise);
  }
}

TEST_CASE("several sets are the sets one by one, bit for bit, with and without ranks") {
  const auto samples = field.samples(50);
  PhotonOptions photons{10'000, Sampler::sobol, 3, 5, 1000};
  const std::array bandwidths{wide, narrow};
  Ranks ranks;
  for (Ranks* shared : {static_cast<Ranks*>(nullptr), &ranks}) {
    photons.ranks = shared;
    const auto sets = photon_fields_of_sets(scene, samples, photons, bandwidths, 3, 4 * photons_of_a_chunk);
    REQUIRE(sets.size() == 3);
    for (std::uint64_t set = 0; set < 3; ++set) {
      PhotonOptions one = photons;
      one.ranks = nullptr;
      one.stream += set;
      const PhotonFields expected = photon_fields(scene, samples, one, bandwidths, 4 * photons_of_a_chunk);
      for (std::size_t k = 0; k < bandwidths.size(); ++k) {
        CHECK(sets[set].estimates[k].irradiance == expected.estimates[k].irradiance);
        CHECK(sets[set].estimates[k].noise == expected.estimates[k].noise);
      }
      CHECK(sets[set].counts.stored == expected.counts.stored);
      CHECK(sets[set].energy.received_w == expected.energy.received_w);
    }
    CHECK(sets[0].estimates[0].irradiance != sets[1].estimates[0].irradiance);
  }
}

TEST_CASE("the memory that photons take is bounded by a batch, or grows where all are kept") {
  CHECK(photon_memory_bytes(4'000'000'000, wide) == photon_memory_bytes(photons_of_a_batch, wide));
  CHECK(photon_memory_bytes(1000, wide) == 36'000);
  CHECK(photon_memory_bytes(4'000'000'000, nearest) == 144'000'000'000);
}

TEST_CASE("photons in flight are given up once a stop is asked for", "[threads]") {
  const auto samples = field.samples(10);
  std::atomic<bool> stop{false};
  PhotonOptions photons{10'000, Sampler::sobol, 3, 2, 1000};
  photons.stop = &stop;
  CHECK_NOTHROW(photon_fields(scene, samples, photons, std::array{wide}));
  stop = true;
  CHECK_THROWS_AS(photon_fields(scene, samples, photons, std::array{wide}), Interrupted);
}
