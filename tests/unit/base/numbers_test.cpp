#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "base/bernstein.h"
#include "base/ordered_sum.h"
#include "base/random_stream.h"
#include "base/units.h"

using namespace catoptric;

TEST_CASE("Philox4x64-10 gives the published numbers") {
  // known-answer vectors of Random123's own kat_vectors file, rows philox4x64 10
  r123::Philox4x64 philox;
  auto zero = philox({{0, 0, 0, 0}}, {{0, 0}});
  CHECK(zero[0] == 0x16554d9eca36314cULL);
  CHECK(zero[1] == 0xdb20fe9d672d0fdcULL);
  CHECK(zero[2] == 0xd7e772cee186176bULL);
  CHECK(zero[3] == 0x7e68b68aec7ba23bULL);
  RandomStream stream(0, static_cast<Purpose>(0), 0);
  CHECK(stream.bits() == 0x16554d9eca36314cULL);
}

TEST_CASE("streams repeat and do not share numbers") {
  std::set<std::uint64_t> seen;
  for (std::uint64_t seed : {1, 2})
    for (Purpose purpose : {Purpose::emission, Purpose::interaction})
      for (std::uint64_t index = 0; index < 100; ++index) {
        RandomStream stream(seed, purpose, index), again(seed, purpose, index);
        for (int draw = 0; draw < 10; ++draw) {
          const std::uint64_t bits = stream.bits();
          CHECK(bits == again.bits());
          CHECK(seen.insert(bits).second);
        }
      }
  CHECK(RandomStream::to_unit(~0ULL) < 1.0);
  CHECK(RandomStream::to_unit(0) == 0.0);
}

TEST_CASE("ordered and compensated sums keep what a plain loop loses") {
  std::vector<double> values(1'000'000, 0.1);
  CHECK(ordered_sum(values) == Approx(100'000).epsilon(1e-15));
  double plain = 0;
  for (double value : values) plain += value;
  CHECK(std::abs(plain - 100'000) > 1e-7);  // the wrong twin: what the sum above is there to avoid
  CompensatedSum sum;
  for (double value : {1.0, 1e100, 1.0, -1e100}) sum.add(value);
  CHECK(sum.value() == 2.0);
}

TEST_CASE("Bernstein polynomials split, multiply and evaluate alike") {
  const std::vector<double> a{1, -2, 3}, b{0.5, 4, -1, 2};
  const auto product = bernstein_product(a, b);
  REQUIRE(product.size() == 6);
  std::vector<double> left, right;
  bernstein_split(product, 0.3, left, right);
  CHECK(left.back() == right.front());
  for (double s : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    CHECK(bernstein_value(product, s) == Approx(bernstein_value(a, s) * bernstein_value(b, s)).margin(1e-14));
    CHECK(bernstein_value(left, s) == Approx(bernstein_value(product, 0.3 * s)));
    CHECK(bernstein_value(right, s) == Approx(bernstein_value(product, 0.3 + 0.7 * s)));
  }
  CHECK(binomial(18, 9) == 48620);
}

TEST_CASE("length units are named and exact") {
  CHECK(millimetres_per(LengthUnit::inch) == 25.4);
  for (auto unit : {LengthUnit::millimetre, LengthUnit::centimetre, LengthUnit::metre, LengthUnit::inch})
    CHECK(parse_length_unit(symbol(unit)) == unit);
  CHECK_FALSE(parse_length_unit("furlong"));
}
