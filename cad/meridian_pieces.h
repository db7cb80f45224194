#pragma once

#include <vector>

#include "cad/meridian_cull.h"
#include "cad/meridian_spans.h"

namespace catoptric::cad::meridian {

/// A piece with the coefficients of F / W^2 split by what the ray contributes:
/// F / W^2 = dz^2 R^2 - h^2 Z^2 - 2 h level Z - (level^2 + skew^2).
/// @from  Bernstein product, Farin, 5th ed., section 5.9; normalised as in Coefficients
struct FastPiece {
  const double *rr, *zz, *z;  ///< 2 degree + 1 each
  double r0, z0, r1, z1;      ///< the ends
  CullNode ring;              ///< of the poles, so of all its points
  double lo, hi;
  int span;
  std::size_t child;  ///< its lower half; the upper one follows. 0: not halved in advance
};

/// What a line contributes to the coefficients of FastPiece.
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
  CATOPTRIC_FORCE_INLINE Real coefficient(const FastPiece& piece, std::size_t i) const {
    return (rr * piece.rr[i] - zz * piece.zz[i]) - (z * piece.z[i] + rest);
  }
};

/// The pieces of a profile: spans cut in two, and these halved in advance, for lines that meet a piece more
/// than once or graze it. Immutable, shared by all probes.
struct FastTable {
  explicit FastTable(const SpanTable& table);
  FastTable(const FastTable&) = delete;
  FastTable& operator=(const FastTable&) = delete;

  static constexpr std::size_t most_levels = 5;  ///< of halving in advance

  std::vector<FastPiece> pieces;
  std::vector<Piece<double>> halvable;  ///< the same pieces, for the solver by halving
  std::size_t top = 0;                  ///< the first `top` pieces make up the generatrix
  std::vector<CullNode> tree;           ///< over these; empty where a tree does not pay

 private:
  void add(const Piece<double>& from, int degree, double* coefficients);
  std::vector<double> coefficients_;  ///< of all pieces, in their order
};

}  // namespace catoptric::cad::meridian
