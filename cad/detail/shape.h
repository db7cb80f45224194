#pragma once

#include <TopoDS_Shape.hxx>
#include <optional>

#include "cad/shape.h"

namespace catoptric::cad::detail {

/// The open optical surface: one face on a surface of revolution about z, ends near the axis set on it.
/// @fails CadError
TopoDS_Shape optical_face(const Profile& profile);

/// The optical face thickened to a solid.
/// @fails CadError when the wall folds, crosses the axis or itself, or the profile is closed
TopoDS_Shape walled_solid(const Profile& profile, const Wall& wall);

/// One or the other.
TopoDS_Shape make_shape(const Profile& profile, const std::optional<Wall>& wall);

/// Area, volume and validity of any shape.
ShapeFigures measure(const TopoDS_Shape& shape);

}  // namespace catoptric::cad::detail
