#pragma once

#include <span>

#include "base/profile.h"

namespace catoptric::cad {

/// The same curve, point by point over the same parameters, written with a higher degree: more control points
/// that a search may move. What was not clamped is.
/// @in    degree from the profile's own to 9
/// @fails InputError for another degree; CadError when OCCT refuses the numbers
/// @error 1e-14 of the profile's size; derivatives: what that error of a control point makes of them
/// @from  OCCT: Geom_BSplineCurve::IncreaseDegree
Profile elevated(const Profile& profile, int degree);

/// The same curve with more knots, each of `new_knots` once more than it is there already. What was not
/// clamped is.
/// @in    new_knots between the first and the last parameter, none more often than the degree
/// @fails InputError for others; CadError when OCCT refuses the numbers
/// @error as elevated
/// @from  OCCT: Geom_BSplineCurve::InsertKnots
Profile with_knots(const Profile& profile, std::span<const double> new_knots);

/// The same curve, each of its spans cut into `parts` of equal parameter.
/// @in    parts >= 1
/// @fails InputError for others, or where a span is too short to be cut
/// @error as elevated
Profile split_spans(const Profile& profile, int parts);

}  // namespace catoptric::cad
