#include "cad/meridian_pieces.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "cad/meridian_isolate.h"

namespace catoptric::cad::meridian {
namespace {

/// Puts lane `lane` of the coefficients of a block. In double: the roundings are far below the certainty that
/// the solver asks of a coefficient.
void put_coefficients(const Piece<double>& from, std::size_t last, std::size_t lane, LaneArray* to) {
  for (std::size_t i = 0; i <= last; ++i)
    for (std::size_t j = 0; j <= last; ++j) {
      const double share = product_binomials[last][i][j] * from.curve.w[i] * from.curve.w[j];
      const double ri = from.curve.rw[i] / from.curve.w[i], rj = from.curve.rw[j] / from.curve.w[j];
      const double zi = from.curve.zw[i] / from.curve.w[i], zj = from.curve.zw[j] / from.curve.w[j];
      LaneArray* const sums = to + 4 * (i + j);
      sums[0][lane] += share * ri * rj;
      sums[1][lane] += share * zi * zj;
      sums[2][lane] += share * 0.5 * (zi + zj);
      sums[3][lane] += share;
    }
  for (std::size_t k = 0; k <= 2 * last; ++k)
    for (std::size_t which = 0; which < 3; ++which) to[4 * k + which][lane] /= to[4 * k + 3][lane];
}

void put_ring(const Piece<double>& from, std::size_t last, std::size_t lane, PieceBlock& to) {
  to.r_min[lane] = to.z_min[lane] = HUGE_VAL;
  to.r_max[lane] = to.z_max[lane] = -HUGE_VAL;
  for (std::size_t i = 0; i <= last; ++i) {
    const double r = from.curve.rw[i] / from.curve.w[i], z = from.curve.zw[i] / from.curve.w[i];
    to.r_min[lane] = std::min(to.r_min[lane], r);
    to.r_max[lane] = std::max(to.r_max[lane], r);
    to.z_min[lane] = std::min(to.z_min[lane], z);
    to.z_max[lane] = std::max(to.z_max[lane], z);
  }
}

PieceBlock empty_block() {
  PieceBlock block{};
  block.child.fill(PieceBlock::no_child);
  return block;
}

/// Lane `lane` becomes the ring that holds all of another block.
void put_hull(const PieceBlock& of, std::size_t lane, PieceBlock& to) {
  const auto count = static_cast<std::ptrdiff_t>(std::popcount(of.used));
  to.r_min[lane] = *std::min_element(of.r_min.begin(), of.r_min.begin() + count);
  to.r_max[lane] = *std::max_element(of.r_max.begin(), of.r_max.begin() + count);
  to.z_min[lane] = *std::min_element(of.z_min.begin(), of.z_min.begin() + count);
  to.z_max[lane] = *std::max_element(of.z_max.begin(), of.z_max.begin() + count);
}

}  // namespace

FastTable::FastTable(const SpanTable& table) {
  const auto poles = static_cast<std::ptrdiff_t>(table.degree) + 1;
  for (const SpanForm& span : table.spans) {
    HalfSpan<double> half{span.rw, span.zw, span.w};
    halves.push_back(half);
    for (std::array<double, most_poles>* numbers : {&half.rw, &half.zw, &half.w})
      std::reverse(numbers->begin(), numbers->begin() + poles);
    halves.push_back(half);
  }
  cut(table);
  add_blocks(0, top);
  const std::size_t top_blocks = blocks.size();
  // Measured on one span: two levels in place of three cost a seventh of the grazing rays a second. Many
  // spans are short already and would only fill the caches.
  constexpr std::size_t most_pieces = 2000;
  for (std::size_t level = 0, first = 0; level < most_levels; ++level) {
    const std::size_t last = blocks.size();
    if (halvable.size() + 16 * (last - first) > most_pieces) break;
    quarter(first, last, table.degree);
    first = last;
  }
  set_coefficients(table.degree);
  roots_end = top_blocks;
  add_runs();
}

/// The pieces that make up the generatrix.
void FastTable::cut(const SpanTable& table) {
  for (const Piece<Quad>& half : table.exact_half)
    if (!table.spans[static_cast<std::size_t>(half.span)].is_point) halvable.push_back(rounded(half));
  if (halvable.size() == 2) {
    const std::vector<Piece<double>> whole = std::move(halvable);
    halvable.resize(2 * whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i)
      halve(whole[i], table.degree, halvable[2 * i], halvable[2 * i + 1]);
  }
  top = halvable.size();
}

/// Blocks for pieces [first, last) of `halvable`.
void FastTable::add_blocks(std::size_t first, std::size_t last) {
  for (; first < last; first += lane_count) {
    PieceBlock block = empty_block();
    for (std::size_t k = 0; k < lane_count && first + k < last; ++k) {
      const Piece<double>& from = halvable[first + k];
      const double hi = from.lo + from.width;
      block.piece[k] = pieces.size();
      block.used |= 1u << k;
      pieces.push_back(
          {from.lo, hi, from.span, 2 * static_cast<std::size_t>(from.span) + (hi <= 0.5 ? 0 : 1)});
    }
    blocks.push_back(block);
  }
}

void FastTable::quarter(std::size_t first_block, std::size_t last_block, int degree) {
  for (std::size_t b = first_block; b < last_block; ++b)
    for (std::size_t k = 0; k < lane_count; ++k) {
      if ((blocks[b].used >> k & 1) == 0) continue;
      Piece<double> lower, upper, part[lane_count];
      halve(halvable[blocks[b].piece[k]], degree, lower, upper);
      halve(lower, degree, part[0], part[1]);
      halve(upper, degree, part[2], part[3]);
      blocks[b].child[k] = blocks.size();
      halvable.insert(halvable.end(), std::begin(part), std::end(part));
      add_blocks(halvable.size() - lane_count, halvable.size());
    }
}

void FastTable::set_coefficients(int degree) {
  const std::size_t last = static_cast<std::size_t>(degree), size = 4 * (2 * last + 1);
  coefficients_.resize(size * blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    blocks[b].coefficients = &coefficients_[size * b];
    for (std::size_t k = 0; k < lane_count; ++k) {
      if ((blocks[b].used >> k & 1) == 0) continue;
      put_ring(halvable[blocks[b].piece[k]], last, k, blocks[b]);
      put_coefficients(halvable[blocks[b].piece[k]], last, k, &coefficients_[size * b]);
    }
  }
}

/// Blocks over blocks, until few are left to begin with.
void FastTable::add_runs() {
  while (roots_end - roots_begin > lane_count) {
    const std::size_t begin = blocks.size();
    for (std::size_t first = roots_begin; first < roots_end; first += lane_count) {
      PieceBlock block = empty_block();
      for (std::size_t k = 0; k < lane_count && first + k < roots_end; ++k) {
        put_hull(blocks[first + k], k, block);
        block.child[k] = first + k;
        block.used |= 1u << k;
      }
      blocks.push_back(block);
    }
    roots_begin = begin;
    roots_end = blocks.size();
  }
}

}  // namespace catoptric::cad::meridian
