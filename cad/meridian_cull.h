#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cad/meridian_line.h"

namespace catoptric::cad::meridian {

/// The ring, r_min to r_max and z_min to z_max, that holds a run of pieces; nodes stand in depth-first order.
struct CullNode {
  double r_min, r_max, z_min, z_max;
  std::size_t first, last;  ///< pieces [first, last)
  std::size_t skip;         ///< the node to go on with when the line misses this one
  bool leaf;
};

/// Tree over pieces in their order along the generatrix; `boxes` are those of single pieces.
/// @cost  O(n log n); a line then looks at O(log n) nodes for each piece it meets
inline std::vector<CullNode> build_cull_tree(const std::vector<CullNode>& boxes) {
  constexpr std::size_t leaf_size = 2;
  std::vector<CullNode> nodes;
  const auto add = [&](const auto& self, std::size_t first, std::size_t last) -> void {
    const std::size_t number = nodes.size();
    CullNode node = boxes[first];
    for (std::size_t i = first + 1; i < last; ++i) {
      node.r_min = std::min(node.r_min, boxes[i].r_min);
      node.r_max = std::max(node.r_max, boxes[i].r_max);
      node.z_min = std::min(node.z_min, boxes[i].z_min);
      node.z_max = std::max(node.z_max, boxes[i].z_max);
    }
    node.first = first;
    node.last = last;
    node.leaf = last - first <= leaf_size;
    nodes.push_back(node);
    if (!node.leaf) {
      const std::size_t middle = (first + last) / 2;
      self(self, first, middle);
      self(self, middle, last);
    }
    nodes[number].skip = nodes.size();
  };
  if (!boxes.empty()) add(add, 0, boxes.size());
  return nodes;
}

/// The stretch of a line in which hits are wanted, and the test of rings against it. Errs towards looking:
/// the slack is far above any rounding, so what it rejects cannot be met, nor can its ends.
template <typename Real>
struct Culler {
  using Truth = decltype(Real{} < Real{});

  Real inverse, across_squared, slack, from, until;
  Truth steep;  ///< else heights do not tell where along the line a point is

  /// For hits beyond `beyond_mm` along the ray.
  CATOPTRIC_FORCE_INLINE void set(const AxisLine<Real>& line, const Real& shift, double beyond_mm,
                                  double size) {
    constexpr double generous = 1e-9;  // far above any rounding of t
    inverse = 1.0 / line.dz;
    across_squared = line.across * line.across;
    slack = generous * (size + absolute(shift));
    from = beyond_mm - shift - slack;
    until = Real(HUGE_VAL);
    steep = absolute(line.dz) >= Real(0x1p-10);
  }

  /// A hit at t was found; none beyond it is wanted any more.
  void found(double t) {
    if (t >= from + 2 * slack) until = std::min(until, t + slack);
  }

  CATOPTRIC_FORCE_INLINE Truth misses(const AxisLine<Real>& line, const CullNode& ring) const {
    const Real zero = Real(0);
    const Real a = (ring.z_min - slack - line.oz) * inverse;
    const Real b = (ring.z_max + slack - line.oz) * inverse;
    const Real lo = greater_of(lesser_of(a, b), from), hi = lesser_of(greater_of(a, b), until);
    if (!any(Truth(steep & (lo <= hi)))) return steep;
    const Real side_lo = line.along + line.h * lo, side_hi = line.along + line.h * hi;
    const Real nearest = greater_of(greater_of(side_lo, -side_hi), zero);
    const Real farthest = greater_of(-side_lo, side_hi);
    const Real outer = ring.r_max + slack, inner = ring.r_min - slack;
    return Truth(steep & ((lo > hi) | (across_squared + nearest * nearest > outer * outer) |
                          ((inner > zero) & (across_squared + farthest * farthest < inner * inner))));
  }
};

}  // namespace catoptric::cad::meridian
