#pragma once

#include "base/profile.h"

namespace catoptric::design {

/// Least radius of curvature of the generatrix; 0 where it has a corner, infinite where it is straight.
/// @error found on 128 points of each span and refined between them to rounding: a bend that is narrower than
///        that is missed
double least_curvature_radius_mm(const Profile& profile);

/// How thick a wall can stand on one side before its other face folds: the least radius of curvature among
/// places that bend towards that side, and the least distance along the normal to the axis.
/// @error as least_curvature_radius_mm
double greatest_wall_mm(const Profile& profile, bool outside);

/// Least angle between the generatrix and the axis, counted negative where the mirror gets narrower on its
/// way to its wider end: what keeps it from being drawn off a mould along the axis.
/// @out   pi/2 for a flat mirror, 0 for a cylinder, negative for an undercut
/// @error as least_curvature_radius_mm
double least_draft_rad(const Profile& profile);

/// How much of the generatrix lies in loops, where it crosses itself, as a share of its length.
struct Loops {
  double share;
  bool certified;  ///< the control polygon shows that there is none
};
/// @error 64 chords a span stand for the curve: a loop smaller than a chord is missed
Loops loops(const Profile& profile);

/// Share of the landing map that runs backwards: from the apex to the rim, reflected rays of a point source
/// on the axis land ever farther out, or ever farther in, but for this share of their way. 0: no folds.
/// @in    source and field: heights on the axis; size_mm: length that is large on the near field
/// @out   in [0, 1/2]; the way is measured as an angle, in which rays that miss the plane have their place
/// @error 256 rays a span, extrema refined: a fold between two of them is missed. First reflections only
double backward_share(const Profile& profile, double source_z_mm, double field_z_mm, double size_mm);

}  // namespace catoptric::design
