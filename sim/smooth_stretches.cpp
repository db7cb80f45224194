#include "sim/smooth_stretches.h"

#include <cmath>

#include "base/tolerance.h"

namespace catoptric::sim {
namespace {

double curvature(const MeridianPoint& at) {
  const double speed = std::hypot(at.dr, at.dz);
  return (at.dr * at.ddz - at.dz * at.ddr) / (speed * speed * speed);
}

/// Whether light on either side of the joint goes on differently. A joint that is smooth but taken for a jump
/// costs some noise, a jump taken for smooth is blurred: so rounding is given little room.
bool jumps(const MeridianPoint& before, const MeridianPoint& after, double size_mm) {
  constexpr double smooth = 1e-9;  // second derivatives of spans in Bernstein form are good to some 1e-12
  const double turn = before.dr * after.dz - before.dz * after.dr;
  const double speeds = std::hypot(before.dr, before.dz) * std::hypot(after.dr, after.dz);
  return !(std::abs(turn) <= smooth * speeds) ||
         !(std::abs(curvature(before) - curvature(after)) * size_mm <= smooth);
}

}  // namespace

std::vector<SmoothStretch> smooth_stretches(const Profile& profile) {
  const double size_mm = profile.diagonal_mm(), on_axis_mm = Tolerance::for_scale(size_mm).length_mm;
  std::vector<SmoothStretch> stretches;
  for (const RationalSpan& span : profile.spans()) {
    const MeridianPoint first = evaluate(span, 0), last = evaluate(span, 1);
    const bool starts = stretches.empty() || jumps(stretches.back().end, first, size_mm);
    if (starts) {
      if (!stretches.empty()) stretches.back().edge_at_end = true;
      const bool edge = !stretches.empty() || first.r_mm > on_axis_mm;
      stretches.push_back({span.first, span.last, first, last, edge, false});
    }
    stretches.back().last = span.last;
    stretches.back().end = last;
  }
  stretches.back().edge_at_end = stretches.back().end.r_mm > on_axis_mm;
  return stretches;
}

}  // namespace catoptric::sim
