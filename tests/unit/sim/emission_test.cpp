#include "sim/emission.h"

#include <catch2/catch.hpp>
#include <set>
#include <vector>

using namespace catoptric::sim;

namespace {

std::vector<std::array<double, 4>> draw(Sampler sampler, std::uint64_t key, std::uint64_t first, int count) {
  const auto numbers = EmissionNumbers::starting_at(sampler, key, first);
  std::vector<std::array<double, 4>> drawn;
  for (int i = 0; i < count; ++i) drawn.push_back(numbers->next());
  return drawn;
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

TEST_CASE("numbers lie in [0, 1), and keys give unrelated sets") {
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

TEST_CASE("scrambled Sobol points are a net for every key; random points are not") {
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
