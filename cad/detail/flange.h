#pragma once

#include <vector>

#include "cad/detail/wall_section.h"

namespace catoptric::cad::detail {

/// The end of the generatrix off the axis, where a flange stands.
struct Rim {
  Vector2 point;    ///< r and z, mm
  Vector2 tangent;  ///< in the direction of the running generatrix
  Vector2 outward;  ///< normal on the side of the wall
};

/// Puts a flat flange in place of the edge that closes the section at the rim. The wall's outer side, and a
/// part of the edge where the flange is thinner than that is high, ends at the flange's face.
/// @in    pieces as wall_section makes them, from the generatrix' start to its end
/// @fails CadError when the flange ends within the wall, or is thicker than the wall's outer side is high
void add_flange(std::vector<SectionPiece>& pieces, const Rim& rim, double width_mm, double thickness_mm);

}  // namespace catoptric::cad::detail
