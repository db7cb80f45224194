#pragma once

#include "base/profile.h"

namespace catoptric::cad {

/// The mirror with a round opening about the axis: the part of the same curve that lies farther out than the
/// opening, over its own parameters. It begins (or ends) at a control point with exactly that radius. A
/// mirror that leaves the opening free already is returned as it is, so that a second cut changes nothing.
/// @in    radius_mm > 0 and less than the mirror's greatest radius
/// @fails InputError for other radii, and where the generatrix meets the opening's edge more than once;
/// CadError
///        when OCCT refuses the new knot
/// @error as with_knots: 1e-14 of the profile's size
/// @from  knot insertion: Piegl & Tiller, The NURBS Book, 2nd ed., section 5.2
Profile with_opening(const Profile& profile, double radius_mm);

}  // namespace catoptric::cad
