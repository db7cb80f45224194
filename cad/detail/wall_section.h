#pragma once

#include <Geom_Curve.hxx>
#include <vector>

#include "base/profile.h"
#include "cad/shape.h"

namespace catoptric::cad::detail {

/// A piece of what bounds a wall beside the optical surface, in the meridian plane y = 0.
struct SectionPiece {
  enum class Kind { line, arc, spline };
  enum class Part { back, edge, flange };
  Kind kind;
  Part part;
  Handle(Geom_Curve) curve;
  double first, last;
};

/// What closes the optical surface's meridian to the section of a walled solid: the outer side, parallel to
/// the generatrix at the wall's thickness and joined by arcs at outward kinks and at a pointed vertex, and
/// the lines between the two sides at ends off the axis. In order along the profile: from its start, over the
/// outer side and a flange, to its end; neighbours share their end points.
/// @fails CadError when the wall folds or crosses the axis, the profile is closed, or there is no place for
///        the flange
/// @error the outer side is within `tolerance_mm` of the parallel curve
std::vector<SectionPiece> wall_section(const Profile& profile, const Wall& wall, double tolerance_mm);

/// How near to the parallel curve the outer side of a part's wall is: 1e-9 of the part, or 1e-7 mm.
double wall_tolerance_mm(const Profile& profile);

/// A straight piece of the section.
SectionPiece straight_piece(SectionPiece::Part part, const Vector2& from, const Vector2& to);

}  // namespace catoptric::cad::detail
