#pragma once

#include <TopoDS_Shape.hxx>

namespace catoptric::cad::detail {

/// Puts triangles within `chord` on the shape's faces.
/// @out   their number
/// @fails CadError when the mesher gives up or a face gets none
int put_facets(const TopoDS_Shape& shape, double chord);

}  // namespace catoptric::cad::detail
