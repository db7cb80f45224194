#include "sim/emission.h"

#include <boost/random/sobol.hpp>

#include "base/contract.h"
#include "base/random_stream.h"

namespace catoptric::sim {
namespace {

class RandomNumbers final : public EmissionNumbers {
 public:
  RandomNumbers(std::uint64_t key, std::uint64_t photon) : key_(key), photon_(photon) {}
  std::array<double, 4> next() override {
    RandomStream stream(key_, Purpose::emission, photon_++);
    std::array<double, 4> numbers{};
    for (double& number : numbers) number = stream.uniform();
    return numbers;
  }

 private:
  std::uint64_t key_, photon_;
};

class SobolNumbers final : public EmissionNumbers {
 public:
  SobolNumbers(std::uint64_t key, std::uint64_t photon) : engine_(4), at_origin_(photon == 0) {
    // The library's engine leaves the sequence's first point, the origin, out; without it the points are no
    // net, and their error is far larger (Owen 2020, On dropping the first Sobol' point).
    if (!at_origin_) engine_.seed(static_cast<std::uint32_t>(photon - 1));
    RandomStream stream(key, Purpose::scrambling, 0);
    for (std::uint32_t& seed : seeds_) seed = static_cast<std::uint32_t>(stream.bits() >> 32);
  }

  std::array<double, 4> next() override {
    std::array<double, 4> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::uint32_t digits = at_origin_ ? 0 : engine_();
      // The middle of the last digit's interval, so that cutting the digits off favours no side.
      numbers[i] = (static_cast<double>(owen_scramble(digits, seeds_[i])) + 0.5) * 0x1p-32;
    }
    at_origin_ = false;
    return numbers;
  }

 private:
  boost::random::sobol_engine<std::uint32_t, 32> engine_;
  bool at_origin_;
  std::array<std::uint32_t, 4> seeds_{};
};

std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
  return __builtin_bswap32(x);
}

}  // namespace

std::uint64_t photon_key(std::uint64_t seed, std::uint64_t stream) {
  return RandomStream(seed, Purpose::scrambling, stream).bits();
}

std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  // In reversed order a multiplication carries only from earlier digits to later ones.
  x = reverse_bits(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reverse_bits(x);
}

std::unique_ptr<EmissionNumbers> EmissionNumbers::starting_at(Sampler sampler, std::uint64_t key,
                                                              std::uint64_t first_photon) {
  CATOPTRIC_EXPECTS(first_photon <= most_photons);
  if (sampler == Sampler::sobol) return std::make_unique<SobolNumbers>(key, first_photon);
  return std::make_unique<RandomNumbers>(key, first_photon);
}

}  // namespace catoptric::sim
