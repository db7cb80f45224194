#pragma once

#include <vector>

#include "base/profile.h"
#include "design/tailored_curve.h"

namespace catoptric::design {

/// Clamped knots over [0, 1] for so many control points: breaks take a knot of multiplicity degree - 1, where
/// the curvature may jump, and the rest are spread evenly between them.
/// @in    degree at least 1, points at least degree + 1; breaks rising within (0, 1), the first of them are
///        served when there are too few points for all
std::vector<double> knots_with_breaks(int degree, std::size_t points, const std::vector<double>& breaks);

/// Whether a curve given by points and slopes meets the axis at a right angle. One that begins with light
/// away from the axis (a dark hole) begins as a cone.
bool begins_smooth(const std::vector<CurvePoint>& curve);

/// The B-spline without weights that comes nearest to a curve given by points and slopes, its parameter the
/// angle over the last angle. It begins in the first point, on the axis and smooth where the curve is, and
/// ends in the last.
/// @in    many points, dense enough for the knots
/// @error least squares of position, and of slope at a tenth of its weight
std::vector<ControlPoint> fit_control_points(const std::vector<CurvePoint>& curve, int degree,
                                             const std::vector<double>& knots);

}  // namespace catoptric::design
