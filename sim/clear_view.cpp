#include "sim/clear_view.h"

#include <algorithm>
#include <cmath>

#include "base/profile_hull.h"
#include "base/tolerance.h"

namespace catoptric::sim {
namespace {

/// The space the samples take: heights, and farthest distance from the axis.
struct Extent {
  double low_mm = HUGE_VAL, high_mm = -HUGE_VAL, r_max_mm = 0;
};

Extent extent_of(std::span<const FieldSample> samples) {
  Extent extent;
  double square = 0;
  for (const FieldSample& sample : samples) {
    const Vector3& p = sample.point_mm;
    extent.low_mm = std::min(extent.low_mm, p.z());
    extent.high_mm = std::max(extent.high_mm, p.z());
    square = std::max(square, p.x() * p.x() + p.y() * p.y());
  }
  extent.r_max_mm = std::sqrt(square);
  return extent;
}

/// Greatest share of its way at which one that starts at height `from` and ends between `low` and `high`, not
/// around `from`, is between the heights of the box; below 0 when none is.
double farthest_share(double from, double low, double high, double box_low, double box_high) {
  // Towards -z mirrored, so that ways rise.
  if (high <= from) return farthest_share(-from, -high, -low, -box_high, -box_low);
  if (box_high < from || box_low > high) return -1;
  // The least steep way is in the box longest.
  return std::min(1.0, (box_high - from) / (low - from));
}

}  // namespace

bool is_view_clear(const Profile& profile, const Vector3& from_mm, std::span<const FieldSample> samples) {
  if (samples.empty()) return true;
  const Tolerance tolerance = Tolerance::for_scale(profile.diagonal_mm());
  const Extent extent = extent_of(samples);
  const double from_z = from_mm.z();
  const double low = std::min(from_z, extent.low_mm), high = std::max(from_z, extent.high_mm);
  const double slack = tolerance.length_mm;
  if (profile.z_min_mm() > high + slack || profile.z_max_mm() < low - slack) return true;
  const bool on_axis = std::hypot(from_mm.x(), from_mm.y()) <= tolerance.length_mm;
  const bool apart =
      from_z < extent.low_mm - tolerance.lift_mm || from_z > extent.high_mm + tolerance.lift_mm;
  if (!on_axis || !apart) return false;
  // Boxes a thirty-second of a span long are tighter than any lamp's way through a mirror.
  constexpr int halvings = 5;
  for (const HullBox& box : hull_boxes(profile, halvings)) {
    const double share =
        farthest_share(from_z, extent.low_mm, extent.high_mm, box.z_min_mm - slack, box.z_max_mm + slack);
    if (share >= 0 && share * extent.r_max_mm >= box.r_min_mm - 2 * slack) return false;
  }
  return true;
}

}  // namespace catoptric::sim
