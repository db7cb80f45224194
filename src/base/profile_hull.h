#pragma once

#include <vector>

#include "base/profile.h"

namespace catoptric {

/// A box in the meridian half-plane that certainly holds a piece of the generatrix.
struct HullBox {
  double r_min_mm, r_max_mm, z_min_mm, z_max_mm;
  double first, last;  ///< the piece's parameter range
};

/// Boxes that together cover the generatrix, each span cut into 2^halvings pieces. By the convex hull
/// property of positive weights no point of the curve lies outside.
/// @cost  O(spans 2^halvings degree^2)
std::vector<HullBox> hull_boxes(const Profile& profile, int halvings);

/// Least and greatest value of one coordinate over a span, to a few roundings of its size.
struct Range {
  double least, greatest;
};
Range range_of_r(const RationalSpan& span);
Range range_of_z(const RationalSpan& span);

}  // namespace catoptric
