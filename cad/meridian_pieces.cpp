#include "cad/meridian_pieces.h"

#include <algorithm>
#include <cmath>

#include "cad/meridian_isolate.h"

namespace catoptric::cad::meridian {

/// In double: the roundings are far below the certainty that the solver asks of a coefficient.
void FastTable::add(const Piece<double>& from, int degree, double* coefficients) {
  const std::size_t last = static_cast<std::size_t>(degree), size = 2 * last + 1;
  FastPiece piece{};
  double *const rr = coefficients, *const zz = rr + size, *const zs = zz + size;
  piece.rr = rr;
  piece.zz = zz;
  piece.z = zs;
  std::array<double, most_poles> r, z;
  piece.ring = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, 0, 0, 0, true};
  for (std::size_t i = 0; i <= last; ++i) {
    r[i] = from.curve.rw[i] / from.curve.w[i];
    z[i] = from.curve.zw[i] / from.curve.w[i];
    piece.ring.r_min = std::min(piece.ring.r_min, r[i]);
    piece.ring.r_max = std::max(piece.ring.r_max, r[i]);
    piece.ring.z_min = std::min(piece.ring.z_min, z[i]);
    piece.ring.z_max = std::max(piece.ring.z_max, z[i]);
  }
  std::array<double, most_coefficients> shares{};
  for (std::size_t i = 0; i <= last; ++i)
    for (std::size_t j = 0; j <= last; ++j) {
      const double share = product_binomials[last][i][j] * from.curve.w[i] * from.curve.w[j];
      rr[i + j] += share * r[i] * r[j];
      zz[i + j] += share * z[i] * z[j];
      zs[i + j] += share * 0.5 * (z[i] + z[j]);
      shares[i + j] += share;
    }
  for (std::size_t k = 0; k < size; ++k) {
    rr[k] /= shares[k];
    zz[k] /= shares[k];
    zs[k] /= shares[k];
  }
  piece.r0 = r[0];
  piece.z0 = z[0];
  piece.r1 = r[last];
  piece.z1 = z[last];
  piece.lo = from.lo;
  piece.hi = from.lo + from.width;
  piece.span = from.span;
  pieces.push_back(piece);
}

FastTable::FastTable(const SpanTable& table) {
  for (const Piece<Quad>& half : table.exact_half)
    if (!table.spans[static_cast<std::size_t>(half.span)].is_point) halvable.push_back(rounded(half));
  top = halvable.size();
  // Measured on one span: three levels against five cost a tenth of the rays a second, a fifth of grazing
  // ones. Many spans are short already and would only fill the caches.
  constexpr std::size_t most_pieces = 1200;
  std::vector<std::size_t> children;
  for (std::size_t level = 0, first = 0; level < most_levels; ++level) {
    if (halvable.size() + 2 * (halvable.size() - first) > most_pieces) break;
    const std::size_t last = halvable.size();
    for (; first < last; ++first) {
      children.push_back(halvable.size());
      Piece<double> left, right;
      halve(halvable[first], table.degree, left, right);
      halvable.push_back(left);
      halvable.push_back(right);
    }
  }
  children.resize(halvable.size(), 0);
  const std::size_t size = 3 * (2 * static_cast<std::size_t>(table.degree) + 1);
  coefficients_.resize(size * halvable.size());
  std::vector<CullNode> rings;
  for (std::size_t i = 0; i < halvable.size(); ++i) {
    add(halvable[i], table.degree, coefficients_.data() + i * size);
    pieces.back().child = children[i];
    if (i < top) rings.push_back(pieces.back().ring);
  }
  constexpr std::size_t few = 4;
  if (top > few) tree = build_cull_tree(rings);
}

}  // namespace catoptric::cad::meridian
