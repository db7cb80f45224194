#pragma once

#include <Geom_Curve.hxx>
#include <vector>

#include "base/profile.h"
#include "cad/shape.h"

namespace catoptric::cad::detail {

/// A piece of the outer side of a wall in the meridian plane y = 0.
struct SectionPiece {
  enum class Kind { line, arc, spline };
  Kind kind;
  Handle(Geom_Curve) curve;
  double first, last;
};

/// What closes the optical surface's meridian to the section of a walled solid: the outer side, parallel to
/// the generatrix at the wall's thickness and joined by arcs at outward kinks and at a pointed vertex, and
/// the lines between the two sides at ends off the axis. In order along the profile: from its start, over the
/// outer side, to its end; neighbours share their end points.
/// @fails CadError when the wall folds or crosses the axis or the profile is closed
/// @error the outer side is within `tolerance_mm` of the parallel curve
std::vector<SectionPiece> wall_section(const Profile& profile, const Wall& wall, double tolerance_mm);

}  // namespace catoptric::cad::detail
