#include "sim/emission.h"

#include <algorithm>
#include <boost/random/sobol.hpp>

#include "base/contract.h"
#include "base/random_stream.h"
#include "base/vector_clones.h"

namespace catoptric::sim {
namespace {

constexpr std::size_t digits = 32;

[[gnu::always_inline]] inline std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
  x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
  return x >> 16 | x << 16;
}

[[gnu::always_inline]] inline std::uint32_t scramble(std::uint32_t x, std::uint32_t seed) {
  // In reversed order a multiplication carries only from earlier digits to later ones.
  x = reverse_bits(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reverse_bits(x);
}

/// The library's Sobol points, ready for whole blocks. In its order (that of the Gray code) point n is the
/// exclusive or of direction numbers, one for each 1 in n ^ n / 2; so the points of a block whose first
/// number is a multiple of its length are the first block's points, each with the same number, the block's
/// own first point, added without carry.
struct SobolPoints {
  static constexpr std::uint64_t block = 1024;
  std::array<std::array<std::uint32_t, digits>, most_emission_numbers> directions;
  std::array<std::array<std::uint32_t, block>, most_emission_numbers> first_block;

  SobolPoints() {
    // The library's engine leaves the sequence's first point, the origin, out; without it the points are no
    // net, and their error is far larger (Owen 2020, On dropping the first Sobol' point).
    boost::random::sobol_engine<std::uint32_t, digits> engine(most_emission_numbers);
    for (std::size_t digit = 0; digit < digits; ++digit) {
      const std::uint64_t number = (std::uint64_t{2} << digit) - 1;  // its Gray code has this digit alone
      engine.seed(static_cast<std::uint32_t>(number - 1));
      for (auto& row : directions) row[digit] = engine();
    }
    for (std::size_t d = 0; d < most_emission_numbers; ++d)
      for (std::uint64_t i = 0; i < block; ++i) first_block[d][i] = point(d, i);
  }

  std::uint32_t point(std::size_t dimension, std::uint64_t number) const {
    std::uint32_t sum = 0;
    const std::uint64_t gray = number ^ number >> 1;
    for (std::size_t digit = 0; digit < digits; ++digit)
      if (gray >> digit & 1) sum ^= directions[dimension][digit];
    return sum;
  }

  static const SobolPoints& table() {
    static const SobolPoints points;
    return points;
  }
};

CATOPTRIC_VECTOR_CLONES
void scramble_block(const std::uint32_t* __restrict points, std::uint32_t origin, std::uint32_t seed,
                    std::size_t count, double* __restrict numbers) {
  for (std::size_t i = 0; i < count; ++i) {
    // Processors turn signed integers into doubles: the number less 2^31, which is then given back exactly.
    const auto less = static_cast<std::int32_t>(scramble(points[i] ^ origin, seed) ^ 0x80000000u);
    // The middle of the last digit's interval, so that cutting the digits off favours no side.
    numbers[i] = (static_cast<double>(less) + (0x1p31 + 0.5)) * 0x1p-32;
  }
}

}  // namespace

std::uint64_t photon_key(std::uint64_t seed, std::uint64_t stream) {
  return RandomStream(seed, Purpose::scrambling, stream).bits();
}

std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) { return scramble(x, seed); }

EmissionNumbers::EmissionNumbers(Sampler sampler, std::uint64_t key) : sampler_(sampler), key_(key) {
  RandomStream stream(key, Purpose::scrambling, 0);
  for (std::uint32_t& seed : seeds_) seed = static_cast<std::uint32_t>(stream.bits() >> 32);
}

void EmissionNumbers::draw(std::uint64_t first, std::span<const std::span<double>> numbers) const {
  CATOPTRIC_EXPECTS(numbers.size() <= most_emission_numbers);
  if (numbers.empty() || numbers[0].empty()) return;
  CATOPTRIC_EXPECTS(first + numbers[0].size() <= most_photons + 1);
  if (sampler_ == Sampler::sobol) return draw_sobol(first, numbers);
  draw_random(first, numbers);
}

void EmissionNumbers::draw_random(std::uint64_t first, std::span<const std::span<double>> numbers) const {
  for (std::size_t i = 0; i < numbers[0].size(); ++i) {
    RandomStream stream(key_, Purpose::emission, first + i);
    for (const std::span<double> row : numbers) row[i] = stream.uniform();
  }
}

void EmissionNumbers::draw_sobol(std::uint64_t first, std::span<const std::span<double>> numbers) const {
  const SobolPoints& sobol = SobolPoints::table();
  constexpr std::uint64_t block = SobolPoints::block;
  const std::uint64_t end = first + numbers[0].size();
  for (std::uint64_t start = first; start < end;) {
    const std::uint64_t base = start - start % block, stop = std::min(end, base + block);
    for (std::size_t d = 0; d < numbers.size(); ++d)
      scramble_block(sobol.first_block[d].data() + (start - base), sobol.point(d, base), seeds_[d],
                     stop - start, numbers[d].data() + (start - first));
    start = stop;
  }
}

}  // namespace catoptric::sim
