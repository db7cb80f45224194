#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace catoptric::sim {

/// Where the emission's random numbers come from.
enum class Sampler {
  random,  ///< Philox, independent numbers
  sobol,   ///< Owen-scrambled Sobol points (randomised quasi-Monte-Carlo)
};

/// Most photons of one set: the Sobol points are made of 32 bits, and a stored photon's place in its map is
/// a 32-bit number.
inline constexpr std::uint64_t most_photons = (std::uint64_t{1} << 32) - 1;

/// Most numbers that a source may ask for a photon.
inline constexpr std::size_t most_emission_numbers = 4;

/// The one number that keys all random numbers of a set of photons: another seed or another stream gives
/// another, unrelated set.
std::uint64_t photon_key(std::uint64_t seed, std::uint64_t stream);

/// Scrambles the binary digits of x: each digit is flipped or not depending on the digits before it and on
/// the seed, so that every elementary interval is mapped onto one of its own size.
/// @from  Owen 1995; by hashing: Laine & Karras 2011, Burley 2020 "Practical Hash-based Owen Scrambling",
///        with the hash constants of Vegdahl 2021
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed);

/// The emission's numbers by photon: photon i gets the same numbers whoever asks, in whatever order and for
/// however many photons at once.
class EmissionNumbers {
 public:
  /// @in key of photon_key()
  EmissionNumbers(Sampler sampler, std::uint64_t key);

  /// numbers[d][i] becomes the d-th number of photon first + i, uniform in [0, 1).
  /// @in    rows of one length, at most most_emission_numbers of them; photons up to most_photons
  /// @cost  about 10 ns a photon for "random", 1 ns a number for "sobol"
  void draw(std::uint64_t first, std::span<const std::span<double>> numbers) const;

 private:
  void draw_random(std::uint64_t first, std::span<const std::span<double>> numbers) const;
  void draw_sobol(std::uint64_t first, std::span<const std::span<double>> numbers) const;

  Sampler sampler_;
  std::uint64_t key_;
  std::array<std::uint32_t, most_emission_numbers> seeds_{};
};

}  // namespace catoptric::sim
