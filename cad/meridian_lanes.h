#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "cad/meridian_real.h"

namespace catoptric::cad::meridian {

inline constexpr std::size_t lane_count = 4;

template <std::size_t Count>
struct VectorTypes;
template <>
struct VectorTypes<2> {
  using Numbers = double __attribute__((vector_size(16)));
  using Bits = std::int64_t __attribute__((vector_size(16)));
};
template <>
struct VectorTypes<4> {
  using Numbers = double __attribute__((vector_size(32)));
  using Bits = std::int64_t __attribute__((vector_size(32)));
};

/// What comparing LanesOf gives: all bits of a lane set, or none.
template <std::size_t Count>
struct alignas(Count * sizeof(double)) MaskOf {
  using Bits = typename VectorTypes<Count>::Bits;
  Bits bits;

  MaskOf() = default;
  CATOPTRIC_FORCE_INLINE MaskOf(const Bits& all) : bits(all) {}
  CATOPTRIC_FORCE_INLINE MaskOf(const MaskOf& other) : bits(other.bits) {}  // as those of LanesOf
  CATOPTRIC_FORCE_INLINE MaskOf& operator=(const MaskOf& other) {
    bits = other.bits;
    return *this;
  }

  CATOPTRIC_FORCE_INLINE bool operator[](std::size_t k) const { return bits[k] != 0; }
  CATOPTRIC_FORCE_INLINE void set(std::size_t k, bool value) { bits[k] = value ? -1 : 0; }
  CATOPTRIC_FORCE_INLINE MaskOf operator~() const { return {~bits}; }
  CATOPTRIC_FORCE_INLINE MaskOf operator&(const MaskOf& other) const { return {bits & other.bits}; }
  CATOPTRIC_FORCE_INLINE MaskOf operator|(const MaskOf& other) const { return {bits | other.bits}; }
  CATOPTRIC_FORCE_INLINE MaskOf operator!=(const MaskOf& other) const { return {bits ^ other.bits}; }
  CATOPTRIC_FORCE_INLINE MaskOf operator==(const MaskOf& other) const { return {~(bits ^ other.bits)}; }
  CATOPTRIC_FORCE_INLINE void operator&=(const MaskOf& other) { bits &= other.bits; }
  CATOPTRIC_FORCE_INLINE void operator|=(const MaskOf& other) { bits |= other.bits; }
};
using Mask = MaskOf<lane_count>;

/// Several numbers side by side: a number type of the solver as double and Quad are. Each lane rounds as the
/// same operation on a double does, whatever the processor. All is forced inline, so that it becomes code of
/// the processor that the calling copy is for (CATOPTRIC_VECTOR_CLONES); never pass four lanes through a
/// call. The plain processor compares two at a time, but not four.
template <std::size_t Count>
struct alignas(Count * sizeof(double)) LanesOf {
  using Numbers = typename VectorTypes<Count>::Numbers;
  Numbers of;

  LanesOf() = default;
  // Spelled out, or GCC copies half vectors at a time, and what then reads whole ones waits for them.
  CATOPTRIC_FORCE_INLINE LanesOf(const LanesOf& other) : of(other.of) {}
  CATOPTRIC_FORCE_INLINE LanesOf& operator=(const LanesOf& other) {
    of = other.of;
    return *this;
  }
  CATOPTRIC_FORCE_INLINE LanesOf(double x) : LanesOf(x, std::make_index_sequence<Count>()) {}
  CATOPTRIC_FORCE_INLINE LanesOf(double a, double b, double c, double d) : of{a, b, c, d} {}
  CATOPTRIC_FORCE_INLINE explicit LanesOf(const Numbers& numbers) : of(numbers) {}

  template <std::size_t... Lane>
  CATOPTRIC_FORCE_INLINE LanesOf(double x, std::index_sequence<Lane...>)
      : of{(static_cast<void>(Lane), x)...} {}

  CATOPTRIC_FORCE_INLINE double operator[](std::size_t k) const { return of[k]; }
  CATOPTRIC_FORCE_INLINE LanesOf operator-() const { return LanesOf(-of); }
  friend CATOPTRIC_FORCE_INLINE LanesOf operator+(const LanesOf& a, const LanesOf& b) {
    return LanesOf(a.of + b.of);
  }
  friend CATOPTRIC_FORCE_INLINE LanesOf operator-(const LanesOf& a, const LanesOf& b) {
    return LanesOf(a.of - b.of);
  }
  friend CATOPTRIC_FORCE_INLINE LanesOf operator*(const LanesOf& a, const LanesOf& b) {
    return LanesOf(a.of * b.of);
  }
  friend CATOPTRIC_FORCE_INLINE LanesOf operator/(const LanesOf& a, const LanesOf& b) {
    return LanesOf(a.of / b.of);
  }
  friend CATOPTRIC_FORCE_INLINE MaskOf<Count> operator<(const LanesOf& a, const LanesOf& b) {
    return {a.of < b.of};
  }
  friend CATOPTRIC_FORCE_INLINE MaskOf<Count> operator>(const LanesOf& a, const LanesOf& b) {
    return {a.of > b.of};
  }
  friend CATOPTRIC_FORCE_INLINE MaskOf<Count> operator<=(const LanesOf& a, const LanesOf& b) {
    return {a.of <= b.of};
  }
  friend CATOPTRIC_FORCE_INLINE MaskOf<Count> operator>=(const LanesOf& a, const LanesOf& b) {
    return {a.of >= b.of};
  }
  friend CATOPTRIC_FORCE_INLINE MaskOf<Count> operator==(const LanesOf& a, const LanesOf& b) {
    return {a.of == b.of};
  }
};
using Lanes = LanesOf<lane_count>;

template <std::size_t Count>
struct Precision<LanesOf<Count>> : Precision<double> {};

CATOPTRIC_FORCE_INLINE bool any(const Mask& where) {
  const Mask::Bits half = where.bits | __builtin_shuffle(where.bits, Mask::Bits{2, 3, 0, 1});
  return (half[0] | half[1]) != 0;
}
template <std::size_t Count>
CATOPTRIC_FORCE_INLINE MaskOf<Count> opposite(const MaskOf<Count>& where) {
  return ~where;
}
/// Bit k is lane k.
CATOPTRIC_FORCE_INLINE unsigned bits_of(const MaskOf<2>& where) {
  return static_cast<unsigned>((where.bits[0] & 1) | (where.bits[1] & 2));
}
CATOPTRIC_FORCE_INLINE unsigned bits_of(const Mask& where) {
  const Mask::Bits one = where.bits & Mask::Bits{1, 2, 4, 8};
  const Mask::Bits half = one | __builtin_shuffle(one, Mask::Bits{2, 3, 0, 1});
  return static_cast<unsigned>(half[0] | half[1]);
}

template <std::size_t Count>
CATOPTRIC_FORCE_INLINE LanesOf<Count> choose(const MaskOf<Count>& where, const LanesOf<Count>& a,
                                             const LanesOf<Count>& b) {
  using Bits = typename MaskOf<Count>::Bits;
  using Numbers = typename LanesOf<Count>::Numbers;
  if constexpr (Count == 2)
    return LanesOf<Count>(Numbers((Bits(a.of) & where.bits) | (Bits(b.of) & ~where.bits)));
  else
    return LanesOf<Count>(where.bits < 0 ? a.of : b.of);
}
CATOPTRIC_FORCE_INLINE Lanes square_root(const Lanes& x) {
  return Lanes(std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3]));
}
template <std::size_t Count>
CATOPTRIC_FORCE_INLINE LanesOf<Count> absolute(const LanesOf<Count>& x) {
  using Bits = typename MaskOf<Count>::Bits;
  using Numbers = typename LanesOf<Count>::Numbers;
  return LanesOf<Count>(Numbers(Bits(x.of) & std::int64_t{0x7fffffffffffffff}));
}

/// The number that get(k) gives for each lane k.
template <typename Get>
CATOPTRIC_FORCE_INLINE Lanes gather(const Get& get) {
  return Lanes(get(0), get(1), get(2), get(3));
}

/// Numbers in memory, where they are written and read singly.
struct alignas(lane_count * sizeof(double)) LaneArray : std::array<double, lane_count> {};
template <std::size_t Count>
CATOPTRIC_FORCE_INLINE LanesOf<Count> lanes_at(const double* from) {
  LanesOf<Count> lanes;
  std::memcpy(&lanes.of, from, sizeof(lanes.of));
  return lanes;
}
template <std::size_t Count>
CATOPTRIC_FORCE_INLINE void store(const LanesOf<Count>& lanes, double* to) {
  std::memcpy(to, &lanes.of, sizeof(lanes.of));
}

}  // namespace catoptric::cad::meridian
