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
  return is_view_clear(profile, from_mm, 0, samples);
}

bool is_view_clear(const Profile& profile, const Vector3& center_mm, double extent_mm,
                   std::span<const FieldSample> samples) {
  if (samples.empty()) return true;
  const Tolerance tolerance = Tolerance::for_scale(profile.diagonal_mm());
  const Extent extent = extent_of(samples);
  const double lowest = center_mm.z() - extent_mm, highest = center_mm.z() + extent_mm;
  const double low = std::min(lowest, extent.low_mm), high = std::max(highest, extent.high_mm);
  const double slack = tolerance.length_mm;
  if (profile.z_min_mm() > high + slack || profile.z_max_mm() < low - slack) return true;
  const double aside_mm = std::hypot(center_mm.x(), center_mm.y());
  const bool apart =
      highest < extent.low_mm - tolerance.lift_mm || lowest > extent.high_mm + tolerance.lift_mm;
  if (!(aside_mm <= tolerance.length_mm) || !apart) return false;
  // Boxes a thirty-second of a span long are tighter than any lamp's way through a mirror.
  constexpr int halvings = 5;
  for (const HullBox& box : hull_boxes(profile, halvings)) {
    // Between the heights of the ball the share only rises or only falls.
    const auto share_from = [&](double height) {
      return farthest_share(height, extent.low_mm, extent.high_mm, box.z_min_mm - slack,
                            box.z_max_mm + slack);
    };
    const double share = std::max(share_from(lowest), share_from(highest));
    const double out_mm = std::max(extent_mm, extent_mm + share * (extent.r_max_mm - extent_mm));
    if (share >= 0 && out_mm >= box.r_min_mm - 2 * slack) return false;
  }
  return true;
}

}  // namespace catoptric::sim
