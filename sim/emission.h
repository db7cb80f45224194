#pragma once

#include <array>
#include <cstdint>
#include <memory>

namespace catoptric::sim {

/// Where the emission's random numbers come from.
enum class Sampler {
  random,  ///< Philox, independent numbers
  sobol,   ///< Owen-scrambled Sobol points (randomised quasi-Monte-Carlo)
};

/// Most photons of one set: the Sobol points are made of 32 bits, and a stored photon's place in its tree is
/// a 32-bit number.
inline constexpr std::uint64_t most_photons = (std::uint64_t{1} << 32) - 1;

/// The one number that keys all random numbers of a set of photons: another seed or another stream gives
/// another, unrelated set.
std::uint64_t photon_key(std::uint64_t seed, std::uint64_t stream);

/// Scrambles the binary digits of x: each digit is flipped or not depending on the digits before it and on
/// the seed, so that every elementary interval is mapped onto one of its own size.
/// @from  Owen 1995; by hashing: Laine & Karras 2011, Burley 2020 "Practical Hash-based Owen Scrambling",
///        with the hash constants of Vegdahl 2021
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed);

/// The emission's numbers for photon after photon, started anywhere: photon i gets the same numbers whoever
/// asks and in whatever order the chunks are worked off. One per task.
class EmissionNumbers {
 public:
  virtual ~EmissionNumbers() = default;
  /// The numbers of the next photon, uniform in [0, 1).
  virtual std::array<double, 4> next() = 0;

  /// @in key of photon_key(); first_photon <= most_photons
  static std::unique_ptr<EmissionNumbers> starting_at(Sampler sampler, std::uint64_t key,
                                                      std::uint64_t first_photon);
};

}  // namespace catoptric::sim
