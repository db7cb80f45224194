#pragma once

#include <cstddef>

namespace catoptric::rayfiles::detail {

/// The blocks of a TM-25 header in bytes.
/// @from  IES TM-25-13 section 4.7
struct Tm25Sizes {
  static constexpr std::size_t date = 28;
  static constexpr std::size_t reserved = 168;
  static constexpr std::size_t text = 4000;
  static constexpr std::size_t label = 512;
  static constexpr std::size_t multiple = 32;  ///< the tables' block is filled up to such a multiple
};

inline constexpr int tm25_version = 2013;

}  // namespace catoptric::rayfiles::detail
