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
class Culler {
 public:
  Culler(const AxisLine<double>& line, double from, double until, double slack)
      : line_(line),
        steep_(std::abs(line.dz) >= 0x1p-10),  // else heights do not tell where along the line a point is
        inverse_(1 / line.dz),
        across_squared_(line.across * line.across),
        slack_(slack),
        from_(from),
        until_(until) {}

  /// A hit at t was found; none beyond it is wanted any more.
  void found(double t) {
    if (t >= from_ + 2 * slack_) until_ = std::min(until_, t + slack_);
  }

  bool misses(const CullNode& ring) const {
    if (!steep_) return false;
    const double a = (ring.z_min - slack_ - line_.oz) * inverse_;
    const double b = (ring.z_max + slack_ - line_.oz) * inverse_;
    const double lo = std::max(std::min(a, b), from_), hi = std::min(std::max(a, b), until_);
    if (lo > hi) return true;
    const double side_lo = line_.along + line_.h * lo, side_hi = line_.along + line_.h * hi;
    const double nearest = std::max({side_lo, -side_hi, 0.0});
    const double farthest = std::max(-side_lo, side_hi);
    const double outer = ring.r_max + slack_, inner = ring.r_min - slack_;
    return across_squared_ + nearest * nearest > outer * outer ||
           (inner > 0 && across_squared_ + farthest * farthest < inner * inner);
  }

 private:
  const AxisLine<double>& line_;
  bool steep_;
  double inverse_, across_squared_, slack_, from_, until_;
};

}  // namespace catoptric::cad::meridian
