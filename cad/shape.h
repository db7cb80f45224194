#pragma once

#include <optional>

#include "base/profile.h"

namespace catoptric::cad {

/// On which side of the optical surface the wall stands. Outside is the side away from the room that the
/// generatrix encloses with the axis, the usual one; inside is for a mirror that is lit from outside.
/// A flat mirror has its wall outside at greater z when the profile runs outward.
enum class WallSide { outside, inside };

/// A flat ring at the rim, across the axis: from the rim's edge outward, one face in the rim's plane, the
/// other on the side where the wall stands. The wall's outer side ends where it meets that one.
struct Flange {
  double width_mm = 0;                 ///< from the rim of the optical surface
  std::optional<double> thickness_mm;  ///< along the axis; nothing: the wall's
};

/// A wall of constant thickness, measured along the normal of the optical surface. Its ends off the axis (the
/// rim, the edge of an opening) stand along the normal too, but for a flange.
struct Wall {
  double thickness_mm = 0;
  WallSide side = WallSide::outside;
  std::optional<Flange> flange = {};  ///< on the outside only
};

/// What the CAD kernel says of a shape.
struct ShapeFigures {
  bool is_valid;      ///< BRepCheck finds no fault
  double area_mm2;    ///< of all faces
  double volume_mm3;  ///< 0 for the open optical surface
  int face_count;
};

/// Least and greatest extent (Profile::diagonal_mm) of a part that can become a CAD shape: 1 um to 1 km. CAD
/// kernels take two points 1e-7 mm apart for one, which at the lower end is 1e-4 of the part: what we write
/// comes back bit for bit, but other programs may heal details finer than that away.
inline constexpr double least_cad_extent_mm = 1e-3;
inline constexpr double greatest_cad_extent_mm = 1e6;

/// Builds the optical surface, or the solid that stands on it, and measures it.
/// @in    wall: nothing for the open surface
/// @fails CadError when the part is too small or too large, or the wall cannot be built (see the message)
/// @error of the shape as built: relative 1e-9, 1e-6 in the area where the profile has kinks. The wall's
/// outer
///        side is within 1e-9 of the part, or 1e-7 mm if that is more, of the parallel surface
ShapeFigures shape_figures(const Profile& profile, const std::optional<Wall>& wall);

/// Refuses a wall or a flange for which there is no room, without building the solid.
/// @fails CadError as shape_figures
/// @cost  some ms
void require_wall(const Profile& profile, const Wall& wall);

}  // namespace catoptric::cad
