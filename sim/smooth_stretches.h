#pragma once

#include <vector>

#include "base/profile.h"

namespace catoptric::sim {

/// A part of the generatrix along which direction and curvature do not jump, so that neither does the light
/// it reflects.
struct SmoothStretch {
  double first, last;               ///< parameters
  MeridianPoint begin, end;         ///< as seen from within
  bool edge_at_begin, edge_at_end;  ///< false on the axis, where the surface goes on
};

/// The generatrix cut at its ends and wherever direction or curvature jump, in order.
std::vector<SmoothStretch> smooth_stretches(const Profile& profile);

}  // namespace catoptric::sim
