#pragma once

#include <bit>

#include "cad/meridian_cull.h"
#include "cad/meridian_isolate.h"
#include "cad/meridian_lanes.h"
#include "cad/meridian_pieces.h"

namespace catoptric::cad::meridian {

/// What a line and the stretch in which hits are wanted say to a block of pieces, in each lane the same.
template <std::size_t Count>
struct BlockQuery {
  using Real = LanesOf<Count>;

  Real oz, along, h;                          ///< of AxisLine
  Real inverse, across_squared, slack, from;  ///< of Culler
  bool steep;                                 ///< of Culler
  Real rr, zz, z, rest, error;                ///< of CrossingFactors

  /// `number` and `truth` give the double and the bool of a member of the first three.
  template <typename Line, typename Cull, typename Factors, typename Number, typename Truth>
  CATOPTRIC_FORCE_INLINE void set(const Line& line, const Cull& culler, const Factors& factors,
                                  const Number& number, const Truth& truth) {
    steep = truth(culler.steep);
    oz = number(line.oz);
    along = number(line.along);
    h = number(line.h);
    inverse = number(culler.inverse);
    across_squared = number(culler.across_squared);
    slack = number(culler.slack);
    from = number(culler.from);
    rr = number(factors.rr);
    zz = number(factors.zz);
    z = number(factors.z);
    rest = number(factors.rest);
    error = number(factors.error);
  }
};

/// Pieces of a block that a line crosses once.
struct Crossings {
  std::array<LaneArray, most_coefficients> f;  ///< coefficients of F
  LaneArray from, until;                       ///< where along the line: between these
};

/// The pieces of a block from `first` on, side by side, against a line.
template <std::size_t Count>
class BlockPart {
 public:
  using Real = LanesOf<Count>;
  using Truth = MaskOf<Count>;

  CATOPTRIC_FORCE_INLINE BlockPart(const BlockQuery<Count>& query, const PieceBlock& block, std::size_t first)
      : query_(query), block_(block), first_(first) {}

  /// Which of the rings the line may meet where hits are wanted, at most `until` along it.
  CATOPTRIC_FORCE_INLINE unsigned met(const Real& until) {
    const Real z_min = at(block_.z_min), z_max = at(block_.z_max);
    const Real r_min = at(block_.r_min), r_max = at(block_.r_max);
    const BlockQuery<Count>& q = query_;
    const Real zero = 0.0;
    const Real a = (z_min - q.slack - q.oz) * q.inverse, b = (z_max + q.slack - q.oz) * q.inverse;
    from_ = lesser_of(a, b);
    until_ = greater_of(a, b);
    const Real lo = greater_of(from_, q.from), hi = lesser_of(until_, until);
    const Real side_lo = q.along + q.h * lo, side_hi = q.along + q.h * hi;
    const Real nearest = greater_of(greater_of(side_lo, -side_hi), zero);
    const Real farthest = greater_of(-side_lo, side_hi);
    const Real outer = r_max + q.slack, inner = r_min - q.slack;
    const auto misses = (lo > hi) | (q.across_squared + nearest * nearest > outer * outer) |
                        ((inner > zero) & (q.across_squared + farthest * farthest < inner * inner));
    return q.steep ? bits_of(~misses) : ~0u;
  }

  /// The coefficients F / W^2, and what their signs tell.
  CATOPTRIC_FORCE_INLINE void set_signs(std::size_t degree) {
    const Real error = query_.error;
    f_[0] = coefficient(0);
    Truth above = f_[0] > error, below = f_[0] < -error;
    Truth certain = above | below, before = below, changed = before & ~before, again = changed;
    for (std::size_t i = 1; i <= 2 * degree; ++i) {
      f_[i] = coefficient(i);
      const Truth is_above = f_[i] > error, is_below = f_[i] < -error;
      const Truth changes = is_below != before;
      above &= is_above;
      below &= is_below;
      certain &= is_above | is_below;
      again |= changed & changes;
      changed |= changes;
      before = is_below;
    }
    doubtful_ = bits_of(~(above | below));
    once_ = bits_of(certain & changed & ~again);
  }
  unsigned once() const { return once_; }          ///< surely crossed once
  unsigned doubtful() const { return doubtful_; }  ///< not surely missed

  /// To be called after both.
  CATOPTRIC_FORCE_INLINE void put(std::size_t degree, Crossings& to) const {
    for (std::size_t i = 0; i <= 2 * degree; ++i)
      store(f_[i] * at(block_.coefficients[4 * i + 3]), to.f[i].data() + first_);
    store(query_.steep ? from_ : Real(-HUGE_VAL), to.from.data() + first_);
    store(query_.steep ? until_ : Real(HUGE_VAL), to.until.data() + first_);
  }

 private:
  CATOPTRIC_FORCE_INLINE Real at(const LaneArray& numbers) const {
    return lanes_at<Count>(numbers.data() + first_);
  }
  CATOPTRIC_FORCE_INLINE Real coefficient(std::size_t i) const {
    const LaneArray* of = block_.coefficients + 4 * i;
    return (query_.rr * at(of[0]) - query_.zz * at(of[1])) - (query_.z * at(of[2]) + query_.rest);
  }

  const BlockQuery<Count>& query_;
  const PieceBlock& block_;
  std::size_t first_;
  std::array<Real, most_coefficients> f_;
  Real from_, until_;
  unsigned once_, doubtful_;
};

/// Tells the sink of the pieces of a block that the line crosses once.
/// @out   bit k: whether the k-th may be crossed, too, but the signs do not tell how often
template <std::size_t Count, typename Sink>
CATOPTRIC_FORCE_INLINE unsigned look_at(const FastTable& fast, const BlockQuery<Count>& query,
                                        const PieceBlock& block, std::size_t degree, Sink& sink) {
  unsigned doubtful = 0;
  for (std::size_t first = 0; first < lane_count; first += Count) {
    BlockPart<Count> part(query, block, first);
    unsigned met = part.met(sink.until()) & block.used >> first & ((1u << Count) - 1);
    if (met != 0 && block.coefficients != nullptr) {
      part.set_signs(degree);
      met &= part.doubtful();
      unsigned once = met & part.once();
      met &= ~once;
      Crossings crossings;
      if (once != 0) part.put(degree, crossings);
      for (; once != 0; once &= once - 1) {
        const std::size_t k = first + static_cast<std::size_t>(std::countr_zero(once));
        sink.crosses(fast.pieces[block.piece[k]], crossings, k);
      }
    }
    doubtful |= met << first;
  }
  return doubtful;
}

/// Goes through the pieces that a line may cross, `Count` side by side. In an order that does not depend on
/// Count, it asks of the sink
///   crosses(piece, crossings, lane)  to take a piece crossed once, which is in that lane of the crossings;
///   until()        how far along the line hits are still wanted;
///   doubts(piece)  to take a piece that is not quartered in advance and of which the signs do not tell
///                  enough, and whether to go on.
/// @out   false when the sink would not go on
template <std::size_t Count, typename Sink>
CATOPTRIC_FORCE_INLINE bool visit_blocks(const FastTable& fast, const BlockQuery<Count>& query,
                                         std::size_t degree, Sink& sink) {
  std::array<std::size_t, FastTable::most_waiting> stack;
  std::size_t size = 0;
  for (std::size_t root = fast.roots_end; root-- > fast.roots_begin;) stack[size++] = root;
  while (size > 0) {
    const PieceBlock& block = fast.blocks[stack[--size]];
    unsigned doubtful = look_at(fast, query, block, degree, sink);
    while (doubtful != 0) {  // the last is pushed first
      const std::size_t k = static_cast<std::size_t>(std::bit_width(doubtful)) - 1;
      doubtful &= ~(1u << k);
      if (block.child[k] != PieceBlock::no_child)
        stack[size++] = block.child[k];
      else if (!sink.doubts(block.piece[k]))
        return false;
    }
  }
  return true;
}

}  // namespace catoptric::cad::meridian
