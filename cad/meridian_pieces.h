#pragma once

#include <array>
#include <limits>
#include <vector>

#include "cad/meridian_lanes.h"
#include "cad/meridian_line.h"
#include "cad/meridian_spans.h"

namespace catoptric::cad::meridian {

/// A half of a span: each coordinate is a sum of c[i] a^i b^(degree - i), where a is s in the lower half and
/// 1 - s in the upper one, and b = 1 - a is no less than 1/2.
template <typename Real>
struct HalfSpan {
  std::array<Real, most_poles> rw, zw, w;
};

/// A piece of a span, from `lo` to `hi` of its parameter.
struct FastPiece {
  double lo, hi;
  int span;
  std::size_t half;  ///< in FastTable::halves
};

/// Four neighbouring pieces, or four runs of them, each with the ring that holds its poles, so all its
/// points.
struct PieceBlock {
  static constexpr std::size_t no_child = std::numeric_limits<std::size_t>::max();

  LaneArray r_min, r_max, z_min, z_max;
  /// Four for each of 2 degree + 1: those of R^2, Z^2 and Z as in Coefficients, and that of W^2. A run of
  /// pieces has none.
  const LaneArray* coefficients;
  std::array<std::size_t, lane_count> piece;  ///< in FastTable::pieces
  std::array<std::size_t, lane_count> child;  ///< in FastTable::blocks: a piece's quarters, a run's parts
  unsigned used;                              ///< bit k: whether there is a k-th
};

/// What a line contributes to the coefficients:
/// F / W^2 = dz^2 R^2 - h^2 Z^2 - 2 h level Z - (level^2 + skew^2).
/// @from  Bernstein product, Farin, 5th ed., section 5.9; normalised as in Coefficients
template <typename Real>
struct CrossingFactors {
  Real rr, zz, z, rest;
  Real error;  ///< above every bound of the solver by halving, at any depth: certain here is certain there

  CATOPTRIC_FORCE_INLINE void set(const AxisLine<Real>& line) {
    rr = line.dz * line.dz;
    zz = line.h * line.h;
    z = 2.0 * line.h * line.level;
    rest = line.level * line.level + line.skew * line.skew;
    error = 0x1p-41 * line.scale * line.scale;
  }
};

/// The pieces of a profile: spans cut in two (one span alone in four), and these quartered in advance, for
/// lines that meet a piece more than once or graze it. Immutable, shared by all probes.
struct FastTable {
  explicit FastTable(const SpanTable& table);
  FastTable(const FastTable&) = delete;
  FastTable& operator=(const FastTable&) = delete;

  static constexpr std::size_t most_levels = 3;    ///< of quartering in advance
  static constexpr std::size_t most_waiting = 64;  ///< blocks on the way down: three a level, and the roots

  std::vector<HalfSpan<double>> halves;  ///< two a span
  std::vector<FastPiece> pieces;
  std::vector<Piece<double>> halvable;  ///< the same pieces, for the solver by halving
  std::size_t top = 0;                  ///< the first `top` pieces make up the generatrix
  std::vector<PieceBlock> blocks;
  std::size_t roots_begin = 0, roots_end = 0;  ///< the blocks to begin with

 private:
  void cut(const SpanTable& table);
  void add_blocks(std::size_t first, std::size_t last);
  void quarter(std::size_t first_block, std::size_t last_block, int degree);
  void set_coefficients(int degree);
  void add_runs();

  std::vector<LaneArray> coefficients_;  ///< of all blocks of pieces, in their order
};

}  // namespace catoptric::cad::meridian
