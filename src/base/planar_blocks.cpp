#include <algorithm>
#include <cmath>
#include <limits>

#include "base/contract.h"
#include "base/float_traps.h"
#include "base/planar_hits.h"
#include "base/tolerance.h"
#include "base/vector_clones.h"

/// First hits of many planar rays on a section of degree 2, several at a time. The loops do what
/// PlanarMirror::first_hit does for the plain case, in the same order, and mark all other rays as unclear.

namespace catoptric {
namespace {

constexpr std::size_t block_rays = 128;  // all arrays of a block stay in the nearest cache
constexpr double roundoff = 0.5 * std::numeric_limits<double>::epsilon();
using Row = double[block_rays];

/// The rays' lines from where they pass nearest to the part's centre, and their nearest hits so far.
struct BlockRows {
  Row x, z, dx, dz, shift, error;
  Row distance, hit_x, hit_z, tangent_x, tangent_z;
  Row unclear;  ///< 1 where the plain case is not certain, else 0
};

/// A span's numbers: `rw`, `zw`, `w` as the signs are taken from (z from the centre), then the exact ones.
struct QuadraticSpan {
  double rw[3], zw[3], w[3];
  double exact_rw[3], exact_zw[3], exact_w[3];
  double side, centre_z, least_speed;
  double vertex_lo, vertex_hi;  ///< 1 where the span ends on the axis, else 0
};

CATOPTRIC_VECTOR_CLONES
void make_lines(const double* __restrict from_x, const double* __restrict from_z,
                const double* __restrict along_x, const double* __restrict along_z, std::size_t count,
                double centre_z, double size, BlockRows& rows) {
  for (std::size_t i = 0; i < count; ++i) {
    const double z = from_z[i] - centre_z, dx = along_x[i], dz = along_z[i];
    const double shift = -(from_x[i] * dx + z * dz);
    rows.x[i] = from_x[i] + shift * dx;
    rows.z[i] = z + shift * dz;
    rows.dx[i] = dx;
    rows.dz[i] = dz;
    rows.shift[i] = shift;
    // As for a single ray with degree 2, the hypotenuse taken larger.
    rows.error[i] = 12 * roundoff * (size + std::abs(rows.x[i]) + std::abs(rows.z[i]));
    rows.distance[i] = HUGE_VAL;
    rows.hit_x[i] = rows.hit_z[i] = rows.tangent_x[i] = rows.tangent_z[i] = 0;
    rows.unclear[i] = std::abs(shift) <= size ? 0 : 1;
  }
}

CATOPTRIC_VECTOR_CLONES
void meet_span(const QuadraticSpan& span, double beyond, std::size_t count, BlockRows& rows) {
  const QuadraticSpan s = span;
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = rows.dx[i], dz = rows.dz[i], x = rows.x[i], z = rows.z[i], error = rows.error[i];
    const double a0 = (s.zw[0] - z * s.w[0]) * dx - (s.side * s.rw[0] - x * s.w[0]) * dz;
    const double a1 = (s.zw[1] - z * s.w[1]) * dx - (s.side * s.rw[1] - x * s.w[1]) * dz;
    const double a2 = (s.zw[2] - z * s.w[2]) * dx - (s.side * s.rw[2] - x * s.w[2]) * dz;
    const double size0 = std::abs(a0), size1 = std::abs(a1), size2 = std::abs(a2);
    const double product = a0 * a2, square = a1 * a1;
    // An end on the line belongs to a neighbour or to nobody; a curve along the line, or one that the line
    // may touch or meet twice, needs more care than signs.
    const bool on_end = (size0 <= s.vertex_lo * error * s.w[0]) | (size2 <= s.vertex_hi * error * s.w[2]);
    const bool along = (size0 <= error * s.w[0]) & (size1 <= error * s.w[1]) & (size2 <= error * s.w[2]);
    const double doubt = 2 * error * (2 * size1 * s.w[1] + size0 * s.w[2] + size2 * s.w[0]);
    const bool unlike = product < 0;
    const bool bends_back = (product > 0) & (a0 * a1 < 0);
    const bool may_touch = bends_back & !(square * (1 + 16 * roundoff) + doubt < product);
    // Unlike signs whose root has no number to be divided by, as after underflow.
    const double q = -(a1 + std::copysign(std::sqrt(square - product), a1));
    const bool lost = (product == 0) | (unlike & (q * a2 == 0));
    const bool unclear = on_end | along | may_touch | lost;
    rows.unclear[i] = unclear ? 1 : rows.unclear[i];

    const bool from_q = q * a2 > 0;
    const double t = (from_q ? q : a0) / (from_q ? q + a2 : a0 + q), rest = 1 - t;
    const double rw0 = rest * s.exact_rw[0] + t * s.exact_rw[1],
                 rw1 = rest * s.exact_rw[1] + t * s.exact_rw[2];
    const double zw0 = rest * s.exact_zw[0] + t * s.exact_zw[1],
                 zw1 = rest * s.exact_zw[1] + t * s.exact_zw[2];
    const double w0 = rest * s.exact_w[0] + t * s.exact_w[1], w1 = rest * s.exact_w[1] + t * s.exact_w[2];
    const double w = rest * w0 + t * w1;
    const double hit_r = (rest * rw0 + t * rw1) / w, hit_z = (rest * zw0 + t * zw1) / w;
    const double hit_x = s.side * hit_r;
    const double rise_w = w1 - w0, along_r = (rw1 - rw0) - rise_w * hit_r,
                 along_z = (zw1 - zw0) - rise_w * hit_z;
    const double distance = rows.shift[i] + (hit_x - x) * dx + ((hit_z - s.centre_z) - z) * dz;

    const bool nearer = unlike & (distance > beyond) & (distance < rows.distance[i]);
    rows.distance[i] = nearer ? distance : rows.distance[i];
    rows.hit_x[i] = nearer ? hit_x : rows.hit_x[i];
    rows.hit_z[i] = nearer ? hit_z : rows.hit_z[i];
    // The derivative times half the weight: its direction is the tangent's.
    const double enough = 0.5 * s.least_speed * w;
    const bool stands = along_r * along_r + along_z * along_z <= enough * enough;
    rows.unclear[i] = nearer & stands ? 1 : rows.unclear[i];
    rows.tangent_x[i] = nearer ? s.side * along_r : rows.tangent_x[i];
    rows.tangent_z[i] = nearer ? along_z : rows.tangent_z[i];
  }
}

CATOPTRIC_VECTOR_CLONES
void hand_over(const BlockRows& rows, std::size_t count, double* __restrict distance, double* __restrict x,
               double* __restrict z, double* __restrict tx, double* __restrict tz) {
  for (std::size_t i = 0; i < count; ++i) {
    const double length =
        std::sqrt(rows.tangent_x[i] * rows.tangent_x[i] + rows.tangent_z[i] * rows.tangent_z[i]);
    distance[i] = rows.distance[i];
    x[i] = rows.hit_x[i];
    z[i] = rows.hit_z[i];
    tx[i] = rows.tangent_x[i] / length;
    tz[i] = rows.tangent_z[i] / length;
  }
}

}  // namespace

struct PlanarMirror::Block {
  std::size_t count;
  bool to_the_right;  ///< all rays start at x >= 0 and go on there
  BlockRows rows;
};

void PlanarMirror::meet_spans(double beyond_mm, Block& block) const {
  for (std::size_t index = 0; index < spans_.size(); ++index) {
    QuadraticSpan span{};
    for (std::size_t i = 0; i < 3; ++i) {
      span.rw[i] = spans_[index].rw[i];
      span.zw[i] = spans_[index].zw[i];
      span.w[i] = spans_[index].w[i];
      span.exact_rw[i] = exact_[index].rw[i];
      span.exact_zw[i] = exact_[index].zw[i];
      span.exact_w[i] = exact_[index].w[i];
    }
    span.centre_z = centre_z_mm_;
    span.least_speed = Tolerance::for_scale(diagonal_mm_).length_mm;
    span.vertex_lo = span.rw[0] == 0;
    span.vertex_hi = span.rw[2] == 0;
    span.side = 1;
    meet_span(span, beyond_mm, block.count, block.rows);
    if (block.to_the_right) continue;  // the image is behind; rays to the vertex itself are unclear
    span.side = -1;
    meet_span(span, beyond_mm, block.count, block.rows);
  }
}

void PlanarMirror::first_hits(const PlanarRays& rays, double beyond_mm, const PlanarFirstHits& hits) const {
  const UntrappedFloats untrapped;  // lanes without a hit compute on; what they have is not taken
  const std::size_t count = rays.x_mm.size();
  CATOPTRIC_EXPECTS(rays.dz.size() == count && hits.distance_mm.size() == count && hits.tz.size() == count);
  Block block;  // not cleared: it is large, and what is read of it is set for every block
  for (std::size_t first = 0; first < count; first += block_rays) {
    block.count = std::min(block_rays, count - first);
    std::fill_n(block.rows.unclear, block.count, 1.0);
    if (degree_ == 2) {
      block.to_the_right = true;
      for (std::size_t i = first; i < first + block.count; ++i)
        block.to_the_right = block.to_the_right && rays.x_mm[i] >= 0 && rays.dx[i] >= 0;
      make_lines(&rays.x_mm[first], &rays.z_mm[first], &rays.dx[first], &rays.dz[first], block.count,
                 centre_z_mm_, size_mm_, block.rows);
      meet_spans(beyond_mm, block);
      hand_over(block.rows, block.count, &hits.distance_mm[first], &hits.x_mm[first], &hits.z_mm[first],
                &hits.tx[first], &hits.tz[first]);
    }
    for (std::size_t i = 0; i < block.count; ++i) {
      if (block.rows.unclear[i] == 0) continue;
      const std::size_t ray = first + i;
      const auto hit = first_hit({rays.x_mm[ray], rays.z_mm[ray], rays.dx[ray], rays.dz[ray]}, beyond_mm);
      hits.distance_mm[ray] = hit ? hit->distance_mm : HUGE_VAL;
      hits.x_mm[ray] = hit ? hit->x_mm : 0;
      hits.z_mm[ray] = hit ? hit->z_mm : 0;
      hits.tx[ray] = hit ? hit->tx : 0;
      hits.tz[ray] = hit ? hit->tz : 0;
    }
  }
}

}  // namespace catoptric
