#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/ray.h"

namespace catoptric::cad::detail {

/// A plane rational curve of degree 2: control points, weights, and flat knots.
struct ConicArc {
  std::string kind;  ///< "ellipse", "parabola" or "hyperbola"
  std::vector<Vector2> points;
  std::vector<double> weights;
  std::vector<double> knots;
};

/// The arc of the conic A x^2 + B x y + C y^2 + D x + E y + F = 0 from `start` to `end`, both on it: on an
/// ellipse counterclockwise (the whole one when they are equal), else the only way there is. Own work, since
/// OCCT 7.6 reads IGES conics wrong unless an ellipse's major axis lies along x.
/// @fails CadError when the conic is degenerate, an end lies off it by more than 1e-6 of the arc, or the ends
///        are on two branches of a hyperbola
/// @error a few roundings of the coefficients
/// @from  Farin, Curves and Surfaces for CAGD, 5th ed., ch. 12; IGES 5.3, section 4.5 for the direction
ConicArc conic_arc(const std::array<double, 6>& coefficients, const Vector2& start, const Vector2& end);

}  // namespace catoptric::cad::detail
