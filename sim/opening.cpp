#include "sim/opening.h"

#include <algorithm>
#include <vector>

#include "base/tolerance.h"

namespace catoptric::sim {
namespace {

/// Control points without repetitions.
std::vector<Vector2> corners_of(const Profile& profile) {
  std::vector<Vector2> corners;
  for (const RationalSpan& span : profile.spans())
    for (std::size_t i = 0; i < span.w.size(); ++i) {
      const Vector2 corner(span.rw[i] / span.w[i], span.zw[i] / span.w[i]);
      if (corners.empty() || corner != corners.back()) corners.push_back(corner);
    }
  return corners;
}

double turn(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Whether the way from the axis to the rim goes outwards and towards the mouth, ever steeper.
bool is_bowl(const std::vector<Vector2>& corners, double outward, double slack_mm) {
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Vector2 step = corners[i + 1] - corners[i];
    if (step.x() < -slack_mm || outward * step.y() < -slack_mm) return false;
    if (i == 0) continue;
    const Vector2 before = corners[i] - corners[i - 1];
    if (outward * turn(before, step) < -slack_mm * (before.norm() + step.norm())) return false;
  }
  return true;
}

}  // namespace

std::optional<Opening> Opening::of(const Profile& profile) {
  const Tolerance tolerance = Tolerance::for_scale(profile.diagonal_mm());
  std::vector<Vector2> corners = corners_of(profile);
  if (corners.back().x() < corners.front().x()) std::reverse(corners.begin(), corners.end());
  if (!(corners.back().x() > tolerance.lift_mm)) return std::nullopt;
  // A mirror with a hole in its apex is a part of the body that a lid on the hole closes.
  if (corners.front().x() > 0) corners.insert(corners.begin(), Vector2(0, corners.front().y()));
  const double outward = corners.back().y() < corners.front().y() ? -1 : 1;
  // A dent of some roundings is no dent: it can throw light back only within the safe distance left below.
  if (!is_bowl(corners, outward, tolerance.length_mm)) return std::nullopt;
  Opening opening;
  opening.rim_z_mm_ = corners.back().y();
  opening.outward_ = outward;
  const double safe_mm = corners.back().x() - tolerance.lift_mm;
  opening.safe_square_mm2_ = safe_mm * safe_mm;
  opening.least_height_mm_ = tolerance.lift_mm;
  return opening;
}

}  // namespace catoptric::sim
