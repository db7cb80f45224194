#include "base/random_stream.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/statistics.h"

using namespace catoptric;

namespace {

constexpr std::uint64_t draws = 200'000;
constexpr std::size_t bins = 16;

std::size_t bin(double share) {
  return std::min(bins - 1, static_cast<std::size_t>(share * static_cast<double>(bins)));
}

/// p-value that pairs of numbers fill the unit square evenly.
template <typename Pair>
double square_p(const Pair& pair) {
  std::vector<double> counts(bins * bins, 0);
  for (std::uint64_t i = 0; i < draws; ++i) {
    const auto [a, b] = pair(i);
    counts[bins * bin(a) + bin(b)] += 1;
  }
  return test::chi_square_even_p(counts);
}

double first_of(std::uint64_t seed, Purpose purpose, std::uint64_t index) {
  return RandomStream(seed, purpose, index).uniform();
}

}  // namespace

TEST_CASE("random numbers are even and unrelated along a stream and across streams, purposes and seeds") {
  using Two = std::pair<double, double>;
  const auto along = [](std::uint64_t i) {
    RandomStream stream(1, Purpose::test, i);
    for (int skipped = 0; skipped < 3; ++skipped) stream.bits();  // the pair lies in two blocks
    const double a = stream.uniform();
    return Two(a, stream.uniform());
  };
  CHECK(test::plausible(square_p(along)));
  CHECK(test::plausible(square_p([](std::uint64_t i) {
    return Two(first_of(1, Purpose::test, i), first_of(1, Purpose::test, i + 1));
  })));
  CHECK(test::plausible(square_p([](std::uint64_t i) {
    return Two(first_of(1, Purpose::emission, i), first_of(1, Purpose::interaction, i));
  })));
  CHECK(test::plausible(square_p([](std::uint64_t i) {
    return Two(first_of(i, Purpose::test, 0), first_of(i + 1, Purpose::test, 0));
  })));
  // the low digits of what becomes a number are as good as the high ones
  CHECK(test::plausible(square_p([](std::uint64_t i) {
    const double a = first_of(1, Purpose::test, i) * 0x1p40, b = first_of(1, Purpose::test, i) * 0x1p20;
    return Two(a - std::floor(a), b - std::floor(b));
  })));
  // wrong twins: a stream that is used twice, and numbers that are bent
  CHECK(test::rejected(square_p(
      [](std::uint64_t i) { return Two(first_of(1, Purpose::test, i), first_of(1, Purpose::test, i)); })));
  CHECK(test::rejected(square_p([&](std::uint64_t i) {
    const auto [a, b] = along(i);
    return Two(std::pow(a, 1.1), b);
  })));
}
