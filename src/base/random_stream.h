#pragma once

#include <Random123/philox.h>

#include <array>
#include <cstdint>

namespace catoptric {

/// What random numbers are used for; each purpose has streams of its own, so that adding a draw in one place
/// never shifts the numbers of another.
enum class Purpose : std::uint32_t {
  emission = 1,
  interaction = 2,
  scrambling = 3,
  search = 4,
  test = 5,
  order = 6
};

/// Counter-based random numbers: the same (seed, purpose, index) gives the same numbers in any order, on any
/// thread. One stream belongs to one photon.
/// @cost  about 10 ns for four numbers
/// @from  Philox4x64-10, Salmon et al. 2011, Random123
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, Purpose purpose, std::uint64_t index)
      : key_{{seed, static_cast<std::uint64_t>(purpose)}}, counter_{{index, 0, 0, 0}} {}

  /// The next number, uniform in [0, 1) with 53 bits.
  double uniform() { return to_unit(bits()); }

  /// The next 64 random bits.
  std::uint64_t bits() {
    if (used_ == 4) {
      block_ = r123::Philox4x64()(counter_, key_);
      ++counter_[1];
      used_ = 0;
    }
    return block_[used_++];
  }

  /// Maps 64 bits to [0, 1): the upper 53 bits, exactly.
  static double to_unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

 private:
  r123::Philox4x64::key_type key_;
  r123::Philox4x64::ctr_type counter_;
  r123::Philox4x64::ctr_type block_{};
  std::size_t used_ = 4;
};

}  // namespace catoptric
