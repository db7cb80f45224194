#include "sim/emission.h"

#include <boost/random/sobol.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "base/random_stream.h"
#include "base/units.h"
#include "sim/turns.h"
#include "support/emission_points.h"

using namespace catoptric::sim;

namespace {

std::vector<std::array<double, 4>> draw(Sampler sampler, std::uint64_t key, std::uint64_t first, int count) {
  return catoptric::test::emission_points(sampler, key, first, static_cast<std::size_t>(count));
}

/// Whether 2^bits points put exactly one into every box of 2^-a by 2^-(bits - a).
bool is_net(const std::vector<std::array<double, 4>>& points, int bits) {
  for (int a = 0; a <= bits; ++a) {
    std::set<std::pair<int, int>> boxes;
    for (const auto& point : points)
      boxes.insert({static_cast<int>(point[0] * (1 << a)), static_cast<int>(point[1] * (1 << (bits - a)))});
    if (boxes.size() != points.size()) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("a photon's numbers do not depend on where the chunk starts") {
  for (Sampler sampler : {Sampler::random, Sampler::sobol}) {
    const auto whole = draw(sampler, 42, 0, 3000);
    for (std::uint64_t first : {1u, 2u, 1023u, 1024u, 2048u, 2999u}) {
      const auto part = draw(sampler, 42, first, static_cast<int>(3000 - first));
      CHECK(std::equal(part.begin(), part.end(), whole.begin() + static_cast<std::ptrdiff_t>(first)));
    }
  }
}

TEST_CASE("numbers are at least 0 and below 1, and keys give unrelated sets") {
  std::set<std::uint64_t> keys;
  for (std::uint64_t seed : {0ull, 1ull, 2ull, ~0ull})
    for (std::uint64_t stream : {0ull, 1ull, 2ull, ~0ull}) keys.insert(photon_key(seed, stream));
  CHECK(keys.size() == 16);
  for (Sampler sampler : {Sampler::random, Sampler::sobol}) {
    std::set<double> seen;
    for (std::uint64_t key : keys)
      for (const auto& point : draw(sampler, key, 0, 8)) {
        for (double number : point) CHECK((number >= 0 && number < 1));
        seen.insert(point[0]);
      }
    CHECK(seen.size() == 16 * 8);
  }
}

TEST_CASE("scrambled Sobol points are a net for every key, random points are not") {
  for (std::uint64_t key = 0; key < 20; ++key) {
    CHECK(is_net(draw(Sampler::sobol, key, 0, 1024), 10));
    CHECK(is_net(draw(Sampler::sobol, key, 4096, 1024), 10));  // any aligned block
  }
  CHECK_FALSE(is_net(draw(Sampler::random, 1, 0, 1024), 10));
  CHECK_FALSE(is_net(draw(Sampler::sobol, 1, 1, 1024), 10));  // the wrong twin: without the origin
}

TEST_CASE("scrambling keeps elementary intervals whole") {
  for (std::uint32_t seed : {0u, 1u, 0x9e3779b9u, ~0u}) {
    std::set<std::uint32_t> images;
    for (std::uint32_t i = 0; i < 4096; ++i) images.insert(owen_scramble(i << 20, seed) >> 20);
    CHECK(images.size() == 4096);
    for (std::uint32_t i = 0; i < 64; ++i)
      CHECK(owen_scramble(i << 26, seed) >> 26 == owen_scramble((i << 26) + 0x2345678u, seed) >> 26);
  }
}

TEST_CASE("the last photon of the largest set can be drawn") {
  CHECK_NOTHROW(draw(Sampler::sobol, 1, most_photons - 1, 1));
}

TEST_CASE("Sobol numbers are the library's points, scrambled, anywhere in the sequence") {
  constexpr std::uint64_t key = 42;
  catoptric::RandomStream stream(key, catoptric::Purpose::scrambling, 0);
  std::array<std::uint32_t, 4> seeds{};
  for (std::uint32_t& seed : seeds) seed = static_cast<std::uint32_t>(stream.bits() >> 32);
  const std::uint64_t half = most_photons / 2;
  for (std::uint64_t first : {half / half, half / 2003, half - 1000, most_photons - 2000}) {
    boost::random::sobol_engine<std::uint32_t, 32> engine(4);
    engine.seed(static_cast<std::uint32_t>(first - 1));  // the library leaves the origin out
    for (const auto& point : draw(Sampler::sobol, key, first, 2000))
      for (std::size_t d = 0; d < 4; ++d)
        REQUIRE(point[d] == (static_cast<double>(owen_scramble(engine(), seeds[d])) + 0.5) * 0x1p-32);
  }
}

TEST_CASE("fewer numbers a photon are the first of all its numbers") {
  for (Sampler sampler : {Sampler::random, Sampler::sobol}) {
    const auto all = draw(sampler, 7, 900, 300);
    std::vector<double> first(300), second(300);
    EmissionNumbers(sampler, 7).draw(900, std::array{std::span(first), std::span(second)});
    for (std::size_t i = 0; i < 300; ++i) REQUIRE((first[i] == all[i][0] && second[i] == all[i][1]));
  }
}

TEST_CASE("cosines and sines of turns are exact to rounding, at every eighth and between") {
  std::vector<double> turns{0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1, 0x1p-60, 1 - 0x1p-53};
  for (std::uint64_t i = 0; i < 100'000; ++i)
    turns.push_back(catoptric::RandomStream(1, catoptric::Purpose::test, i).uniform());
  std::vector<double> cosines(turns.size()), sines(turns.size());
  cosines_and_sines(turns, cosines, sines);
  double worst = 0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const long double angle = 2 * 3.14159265358979323846264338327950288L * turns[i];
    worst = std::max({worst, std::abs(static_cast<double>(std::cos(angle) - cosines[i])),
                      std::abs(static_cast<double>(std::sin(angle) - sines[i]))});
  }
  CHECK(worst < 2 * 0x1p-53);  // rounding of the angle, of the polynomial's last steps and of the result
  CHECK(cosines[0] == 1);
  CHECK(sines[2] == 1);
  CHECK(cosines[2] == 0);
}
