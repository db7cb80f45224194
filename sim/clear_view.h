#pragma once

#include <span>

#include "base/profile.h"
#include "sim/near_field.h"

namespace catoptric::sim {

/// Whether the mirror certainly stands between a point and none of the samples, so that no intersection need
/// be asked for.
///
/// Proof. All the ways lie between the least and the greatest height of their ends; a mirror wholly above or
/// below stands in none. From a point on the axis a way stays in one half-plane through the axis, and at the
/// share t of its height it is t times its end's radius from the axis; a box of the generatrix' hull that
/// begins farther out than the farthest way at any height it shares with them is met by none. Lengths as long
/// as rounding may make them count for the mirror, and what Probe::blocks counts as no hit, next to the ends,
/// does not count here.
/// @out   false where the proof fails; that something is in the way is then possible, not certain
/// @cost  O(samples), some ns each, and where heights overlap O(spans)
bool is_view_clear(const Profile& profile, const Vector3& from_mm, std::span<const FieldSample> samples);

/// The same for all points of a ball about the place. At the share t of its height a way from it is at most
/// (1 - t) times its start's and t times its end's distance from the axis.
bool is_view_clear(const Profile& profile, const Vector3& center_mm, double extent_mm,
                   std::span<const FieldSample> samples);

}  // namespace catoptric::sim
