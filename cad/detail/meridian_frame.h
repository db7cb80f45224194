#pragma once

#include <Geom_BSplineCurve.hxx>
#include <gp_Ax1.hxx>
#include <optional>
#include <string>

#include "base/profile.h"

namespace catoptric::cad::detail {

/// A curve in the half-plane of its axis.
struct MeridianCurve {
  Handle(
      Geom_BSplineCurve) curve;  ///< in the plane y = 0: x is r, z along the axis; from smaller to greater r
  double moved_mm = 0;           ///< how far points were moved onto the plane and the axis
  bool turned_round = false;     ///< ran from greater to smaller r in the file
};

/// The curve as seen from the axis, or in words why it is no meridian of it.
struct MeridianView {
  std::optional<MeridianCurve> meridian;
  std::string fault;
  bool is_in_plane = true;  ///< with the axis
};

/// @in  axis: its location is z = 0, its direction +z
MeridianView see_from_axis(const Handle(Geom_BSplineCurve) & curve, const gp_Ax1& axis);

/// The axis with its location moved to where the file's origin falls on it.
gp_Ax1 from_origin(const gp_Ax1& axis);

/// The coordinate axis that lies in a plane with the curve and is nearest to one of its ends; z before y
/// before x when equally near. Whether the curve crosses it is left to see_from_axis: a second-best axis
/// would be a guess.
struct PrincipalAxis {
  gp_Ax1 axis;
  std::string name;    ///< "z"
  std::string rivals;  ///< others that could have been meant, "" for none: in that plane, not crossed,
                       ///< and touched by an end if this one is
};
std::optional<PrincipalAxis> nearest_principal_axis(const Handle(Geom_BSplineCurve) & curve);

}  // namespace catoptric::cad::detail
