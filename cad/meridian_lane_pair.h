#pragma once

#include "cad/meridian_lanes.h"

namespace catoptric::cad::meridian {

/// Two sets of lanes, whose operations stand side by side in the code: one's divisions fill the other's
/// waiting.
struct MaskPair {
  Mask a, b;

  CATOPTRIC_FORCE_INLINE MaskPair operator~() const { return {~a, ~b}; }
  CATOPTRIC_FORCE_INLINE MaskPair operator&(const MaskPair& o) const { return {a & o.a, b & o.b}; }
  CATOPTRIC_FORCE_INLINE MaskPair operator|(const MaskPair& o) const { return {a | o.a, b | o.b}; }
  CATOPTRIC_FORCE_INLINE MaskPair operator==(const MaskPair& o) const { return {a == o.a, b == o.b}; }
  CATOPTRIC_FORCE_INLINE void operator&=(const MaskPair& o) { *this = *this & o; }
  CATOPTRIC_FORCE_INLINE void operator|=(const MaskPair& o) { *this = *this | o; }
  CATOPTRIC_FORCE_INLINE bool operator[](std::size_t k) const {
    return k < lane_count ? a[k] : b[k - lane_count];
  }
};

struct LanePair {
  Lanes a, b;

  LanePair() = default;
  CATOPTRIC_FORCE_INLINE LanePair(double x) : a(x), b(x) {}
  CATOPTRIC_FORCE_INLINE LanePair(const Lanes& x, const Lanes& y) : a(x), b(y) {}

  CATOPTRIC_FORCE_INLINE LanePair operator-() const { return {-a, -b}; }
  friend CATOPTRIC_FORCE_INLINE LanePair operator+(const LanePair& x, const LanePair& y) {
    return {x.a + y.a, x.b + y.b};
  }
  friend CATOPTRIC_FORCE_INLINE LanePair operator-(const LanePair& x, const LanePair& y) {
    return {x.a - y.a, x.b - y.b};
  }
  friend CATOPTRIC_FORCE_INLINE LanePair operator*(const LanePair& x, const LanePair& y) {
    return {x.a * y.a, x.b * y.b};
  }
  friend CATOPTRIC_FORCE_INLINE LanePair operator/(const LanePair& x, const LanePair& y) {
    return {x.a / y.a, x.b / y.b};
  }
  friend CATOPTRIC_FORCE_INLINE MaskPair operator<(const LanePair& x, const LanePair& y) {
    return {x.a < y.a, x.b < y.b};
  }
  friend CATOPTRIC_FORCE_INLINE MaskPair operator>(const LanePair& x, const LanePair& y) {
    return {x.a > y.a, x.b > y.b};
  }
  friend CATOPTRIC_FORCE_INLINE MaskPair operator<=(const LanePair& x, const LanePair& y) {
    return {x.a <= y.a, x.b <= y.b};
  }
  friend CATOPTRIC_FORCE_INLINE MaskPair operator>=(const LanePair& x, const LanePair& y) {
    return {x.a >= y.a, x.b >= y.b};
  }
};

template <>
struct Precision<LanePair> : Precision<double> {};

CATOPTRIC_FORCE_INLINE bool any(const MaskPair& where) { return any(where.a | where.b); }
CATOPTRIC_FORCE_INLINE MaskPair opposite(const MaskPair& where) { return ~where; }
CATOPTRIC_FORCE_INLINE LanePair choose(const MaskPair& where, const LanePair& x, const LanePair& y) {
  return {choose(where.a, x.a, y.a), choose(where.b, x.b, y.b)};
}
CATOPTRIC_FORCE_INLINE LanePair square_root(const LanePair& x) {
  return {square_root(x.a), square_root(x.b)};
}
CATOPTRIC_FORCE_INLINE LanePair absolute(const LanePair& x) { return {absolute(x.a), absolute(x.b)}; }

/// The number that get(k) gives for each lane k.
template <typename Get>
CATOPTRIC_FORCE_INLINE LanePair gather_pair(const Get& get) {
  return {Lanes(get(0), get(1), get(2), get(3)), Lanes(get(4), get(5), get(6), get(7))};
}

struct alignas(lane_count * sizeof(double)) PairArray : std::array<double, 2 * lane_count> {};
CATOPTRIC_FORCE_INLINE LanePair pair_of(const PairArray& from) {
  return {lanes_at<lane_count>(from.data()), lanes_at<lane_count>(from.data() + lane_count)};
}
CATOPTRIC_FORCE_INLINE void store(const LanePair& lanes, PairArray& to) {
  store(lanes.a, to.data());
  store(lanes.b, to.data() + lane_count);
}

}  // namespace catoptric::cad::meridian
