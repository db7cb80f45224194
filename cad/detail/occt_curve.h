#pragma once

#include <Geom_BSplineCurve.hxx>

#include "base/profile.h"

namespace catoptric::cad::detail {

/// The generatrix as OCCT's curve in the plane y = 0, r along x: same degree, poles, weights and knots, bit
/// for bit, lengths times `scale`. Equal weights come out as a polynomial curve, which is the same curve.
/// @fails CadError when OCCT refuses the numbers (two knots nearer than a rounding)
Handle(Geom_BSplineCurve) occt_curve(const Profile& profile, double scale = 1.0);

/// Repeats the end knots degree + 1 times where they are not, so that the curve begins and ends at control
/// points.
/// @fails Standard_Failure: to be called under the guard
void clamp(const Handle(Geom_BSplineCurve) & curve);

/// The same curve as CAD programs want it: clamped (they cut other knots off at the ends), and an end that
/// lies within OCCT's confusion (1e-7 model units) of the axis set on it, where a tiny circle would stay
/// open.
/// @error bit for bit where the profile is clamped, a few roundings elsewhere
Handle(Geom_BSplineCurve) occt_cad_curve(const Profile& profile, double scale = 1.0);

/// The generatrix held by a curve in the plane y = 0 (which the caller has checked), lengths times `scale`.
/// A periodic curve is opened at its seam. Weights beyond the range we allow are divided by a common factor.
/// @fails InputError when the numbers are no generatrix (Profile says why)
Profile profile_of(const Handle(Geom_BSplineCurve) & curve, double scale = 1.0);

}  // namespace catoptric::cad::detail
