#pragma once

#include <cmath>
#include <limits>

/// Before functions that are also made for numbers of several rays (meridian_lanes.h).
#define CATOPTRIC_FORCE_INLINE inline __attribute__((always_inline))

namespace catoptric::cad::meridian {

/// The number type of the rare rays that double cannot decide: 113 bits where the compiler offers them.
#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Quad;
inline constexpr int quad_bits = 113;
#else
using Quad = long double;
inline constexpr int quad_bits = std::numeric_limits<long double>::digits;
#endif

constexpr Quad power_of_two(int exponent) {
  Quad value = 1;
  for (int i = 0; i < exponent; ++i) value *= 2;
  for (int i = 0; i > exponent; --i) value *= Quad(0.5);
  return value;
}

/// What the solver needs to know of a number type.
template <typename Real>
struct Precision;

template <>
struct Precision<double> {
  static constexpr double unit_roundoff = 0x1p-53;
  static constexpr int deepest = 48;  ///< halvings of a span whose ends are still exact doubles
};

template <>
struct Precision<Quad> {
  static constexpr Quad unit_roundoff = power_of_two(-quad_bits);
  static constexpr int deepest = quad_bits - 5;
};

inline double square_root(double x) { return std::sqrt(x); }

/// Square root to a rounding or two: Newton from the double root, after bringing x into double's range by
/// powers of four.
inline Quad square_root(Quad x) {
  if (!(x > 0)) return 0;
  Quad back = 1;
  for (const Quad low = power_of_two(-512); x < low; x *= power_of_two(1024)) back *= power_of_two(-512);
  for (const Quad high = power_of_two(512); x > high; x *= power_of_two(-1024)) back *= power_of_two(512);
  Quad root = std::sqrt(static_cast<double>(x));
  for (int i = 0; i < 2; ++i) root = (root + x / root) / 2;
  return root * back;
}

inline double absolute(double x) { return std::abs(x); }
inline Quad absolute(Quad x) { return x < 0 ? -x : x; }

/// `where ? a : b` in terms that a number type of several rays at a time has, too.
template <typename Real>
CATOPTRIC_FORCE_INLINE Real choose(bool where, const Real& a, const Real& b) {
  return where ? a : b;
}
inline bool any(bool where) { return where; }
inline bool opposite(bool where) { return !where; }

template <typename Real>
CATOPTRIC_FORCE_INLINE Real greater_of(const Real& a, const Real& b) {
  return choose(a < b, b, a);
}
template <typename Real>
CATOPTRIC_FORCE_INLINE Real lesser_of(const Real& a, const Real& b) {
  return choose(b < a, b, a);
}

}  // namespace catoptric::cad::meridian
