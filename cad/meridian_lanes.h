#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cad/meridian_real.h"

namespace catoptric::cad::meridian {

inline constexpr std::size_t lane_count = 4;
inline constexpr std::size_t lane_bytes = lane_count * sizeof(double);

/// What comparing Lanes gives: all bits of a lane set, or none.
struct alignas(lane_bytes) Mask {
  using Bits = std::int64_t __attribute__((vector_size(lane_bytes)));
  Bits bits;

  CATOPTRIC_FORCE_INLINE bool operator[](std::size_t k) const { return bits[k] != 0; }
  CATOPTRIC_FORCE_INLINE void set(std::size_t k, bool value) { bits[k] = value ? -1 : 0; }
  CATOPTRIC_FORCE_INLINE Mask operator~() const { return {~bits}; }
  CATOPTRIC_FORCE_INLINE Mask operator&(const Mask& other) const { return {bits & other.bits}; }
  CATOPTRIC_FORCE_INLINE Mask operator|(const Mask& other) const { return {bits | other.bits}; }
  CATOPTRIC_FORCE_INLINE Mask operator!=(const Mask& other) const { return {bits ^ other.bits}; }
  CATOPTRIC_FORCE_INLINE Mask operator==(const Mask& other) const { return {~(bits ^ other.bits)}; }
  CATOPTRIC_FORCE_INLINE void operator&=(const Mask& other) { bits &= other.bits; }
  CATOPTRIC_FORCE_INLINE void operator|=(const Mask& other) { bits |= other.bits; }
};

CATOPTRIC_FORCE_INLINE bool any(const Mask& where) { return where[0] | where[1] | where[2] | where[3]; }

/// Numbers of four rays side by side: a number type of the solver as double and Quad are. Each lane rounds as
/// the same operation on a double does, whatever the processor. All is forced inline, so that it becomes code
/// of the processor that the calling copy is for (CATOPTRIC_VECTOR_CLONES); never pass Lanes through a call.
struct alignas(lane_bytes) Lanes {
  using Numbers = double __attribute__((vector_size(lane_bytes)));
  Numbers of;

  Lanes() = default;
  CATOPTRIC_FORCE_INLINE Lanes(double x) : of{x, x, x, x} {}
  CATOPTRIC_FORCE_INLINE Lanes(double a, double b, double c, double d) : of{a, b, c, d} {}
  CATOPTRIC_FORCE_INLINE explicit Lanes(const Numbers& numbers) : of(numbers) {}

  CATOPTRIC_FORCE_INLINE double operator[](std::size_t k) const { return of[k]; }
  CATOPTRIC_FORCE_INLINE Lanes operator-() const { return Lanes(-of); }
  friend CATOPTRIC_FORCE_INLINE Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes(a.of + b.of); }
  friend CATOPTRIC_FORCE_INLINE Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes(a.of - b.of); }
  friend CATOPTRIC_FORCE_INLINE Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes(a.of * b.of); }
  friend CATOPTRIC_FORCE_INLINE Lanes operator/(const Lanes& a, const Lanes& b) { return Lanes(a.of / b.of); }
  friend CATOPTRIC_FORCE_INLINE Mask operator<(const Lanes& a, const Lanes& b) { return {a.of < b.of}; }
  friend CATOPTRIC_FORCE_INLINE Mask operator>(const Lanes& a, const Lanes& b) { return {a.of > b.of}; }
  friend CATOPTRIC_FORCE_INLINE Mask operator<=(const Lanes& a, const Lanes& b) { return {a.of <= b.of}; }
  friend CATOPTRIC_FORCE_INLINE Mask operator>=(const Lanes& a, const Lanes& b) { return {a.of >= b.of}; }
  friend CATOPTRIC_FORCE_INLINE Mask operator==(const Lanes& a, const Lanes& b) { return {a.of == b.of}; }
};

template <>
struct Precision<Lanes> : Precision<double> {};

/// The number that get(k) gives for each lane k.
template <typename Get>
CATOPTRIC_FORCE_INLINE Lanes gather(const Get& get) {
  return Lanes(get(0), get(1), get(2), get(3));
}

CATOPTRIC_FORCE_INLINE Lanes choose(const Mask& where, const Lanes& a, const Lanes& b) {
  return Lanes(where.bits ? a.of : b.of);
}
CATOPTRIC_FORCE_INLINE Lanes square_root(const Lanes& x) {
  return Lanes(std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3]));
}
CATOPTRIC_FORCE_INLINE Lanes absolute(const Lanes& x) {
  return Lanes(Lanes::Numbers(Mask::Bits(x.of) & std::int64_t{0x7fffffffffffffff}));
}

}  // namespace catoptric::cad::meridian
