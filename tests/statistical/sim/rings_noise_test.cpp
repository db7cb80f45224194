#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "cad/engines.h"
#include "sim/rings.h"
#include "support/analytic_reflectors.h"
#include "support/statistics.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double power = pi / 100;
const PointSource source({0, 0, 50}, power);
const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);

const Reflector& mirror() {
  static const auto made =
      cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}));
  return *made;
}

double eq12(double r) {
  const double t = 1 + r * r / 10'000;
  return power / (4 * pi * 2500 * t * t);
}

RingsOptions options(std::uint64_t photons, Sampler sampler, std::uint64_t stream) {
  RingsOptions made;
  made.photons = {photons, sampler, 1, stream, 1000};
  return made;
}

/// Places so far apart that their estimates share few photons: axis, inside, rim.
const std::vector<double> places{0, 45, 65, 82, 99.9};

struct Coverage {
  std::size_t held = 0, held_by_half = 0, of = 0;  ///< by the interval, by one half as wide, judged
  double share() const { return static_cast<double>(held) / static_cast<double>(of); }
};

Coverage coverage(const RingsOptions& base, std::uint64_t seeds) {
  Coverage seen;
  RingsOptions given = base;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    given.photons.seed = 1000 + seed;
    const auto got = rings_field({source, mirror(), {}, field}, places, given);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double off = std::abs(got.debiased[i] - eq12(places[i])), half = got.half_interval(i, 0.95);
      seen.held += off <= half;
      seen.held_by_half += off <= 0.5 * half;
      ++seen.of;
    }
  }
  return seen;
}

double noise_rmse(std::uint64_t photons, Sampler sampler, double bandwidth,
                  RingStorage storage = RingStorage::counted) {
  // Against a reference of the same bandwidth with so many photons that it has no noise: noise alone is left.
  auto many = options(400'000, Sampler::sobol, 99);
  many.bandwidth_mm2 = bandwidth;
  many.storage = storage;
  const auto reference = rings_field({source, mirror(), {}, field}, places, many);
  double sum = 0;
  constexpr std::uint64_t streams = 40;
  for (std::uint64_t stream = 0; stream < streams; ++stream) {
    auto given = options(photons, sampler, stream);
    given.bandwidth_mm2 = bandwidth;
    given.storage = storage;
    const auto got = rings_field({source, mirror(), {}, field}, places, given);
    for (std::size_t i = 0; i < places.size(); ++i)
      sum += std::pow(got.irradiance[i] - reference.irradiance[i], 2);
  }
  return std::sqrt(sum / (streams * static_cast<double>(places.size())));
}

}  // namespace

TEST_CASE("rings: noise of random photons falls by N^-1/2, of Sobol points by N^-3/2, in bins by 1/N",
          "[long]") {
  // 200 values each: an RMSE is good to 5 %, a slope over a factor of 10 to 0.03; five of these and more for
  // the places' own spread.
  const auto slope = [](double few, double many) { return std::log10(many / few); };
  const double random = noise_rmse(2'000, Sampler::random, 500);
  CHECK(slope(random, noise_rmse(20'000, Sampler::random, 500)) == Approx(-0.5).margin(0.2));
  const auto sorted = RingStorage::sorted;
  const double few = noise_rmse(1'000, Sampler::sobol, 500, sorted);
  CHECK(few < 0.5 * random);
  CHECK(slope(few, noise_rmse(10'000, Sampler::sobol, 500, sorted)) == Approx(-1.5).margin(0.2));
  // A bin rounds the places of the photons at its edges: by less than one photon, however many there are.
  const double counted = noise_rmse(2'000, Sampler::sobol, 500);
  CHECK(slope(counted, noise_rmse(20'000, Sampler::sobol, 500)) == Approx(-1).margin(0.2));
}

TEST_CASE("rings: the replicates' noise is the noise, and Poisson's for random photons", "[long]") {
  auto given = options(8'000, Sampler::random, 0);
  given.bandwidth_mm2 = 600;
  constexpr int streams = 300;
  std::vector<RingsField> runs;
  for (int stream = 0; stream < streams; ++stream) {
    given.photons.stream = static_cast<std::uint64_t>(stream);
    runs.push_back(rings_field({source, mirror(), {}, field}, places, given));
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    double mean = 0, square = 0, replicate = 0, poisson = 0;
    for (const RingsField& got : runs) {
      mean += got.irradiance[i] / streams;
      square += got.irradiance[i] * got.irradiance[i] / streams;
      replicate += got.noise[i] * got.noise[i] / streams;
      poisson += got.poisson_noise[i] * got.poisson_noise[i] / streams;
    }
    const double variance = (square - mean * mean) * streams / (streams - 1);
    CAPTURE(places[i]);
    // Sample variances of 300 values: relative standard deviation sqrt(2 / 299); of 300 times 3 degrees of
    // freedom sqrt(2 / 900); five of both together. Poisson's leaves out that the total is fixed: at most the
    // share of all photons that the kernel sees, 600 / 10000 of the field's range.
    const double margin = 5 * std::sqrt(2.0 / 299 + 2.0 / 900);
    CHECK(replicate / variance == Approx(1).margin(margin));
    CHECK(poisson / variance == Approx(1).margin(5 * std::sqrt(2.0 / 299) + 0.12));
    CHECK_FALSE(replicate / (2.25 * variance) == Approx(1).margin(margin));  // wrong twin: noise 1.5 times
  }
}

TEST_CASE("rings: the 95 % interval holds the truth for 95 % of 200 seeds", "[long]") {
  for (Sampler sampler : {Sampler::random, Sampler::sobol}) {
    const Coverage seen = coverage(options(4'000, sampler, 0), 200);
    CAPTURE(static_cast<int>(sampler), seen.held, seen.of);
    CHECK(test::plausible(test::binomial_p(seen.held, seen.of, 0.95)));  // the places share few photons
    CHECK(test::rejected(test::binomial_p(seen.held_by_half, seen.of, 0.95)));  // wrong twin
  }
}

TEST_CASE("rings: the 95 % interval holds the truth for 93 to 97 % of 1000 seeds", "[.long]") {
  for (Sampler sampler : {Sampler::random, Sampler::sobol})
    for (std::uint64_t photons : {4'000, 40'000}) {
      const Coverage seen = coverage(options(photons, sampler, 0), 1000);
      CAPTURE(static_cast<int>(sampler), photons, seen.share());
      CHECK(seen.share() > 0.93);
      CHECK(seen.share() < 0.97);
    }
}
