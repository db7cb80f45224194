#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "design/flux_map.h"

namespace catoptric::design {

/// The two ways to fill the near field from its centre outwards: the light of each half of the meridian stays
/// on its side of the axis, or crosses it.
enum class RayMap { diverging, crossing };
std::string_view name(RayMap map);

/// Source, mirror and near field along the axis.
struct AxialLayout {
  double source_z_mm;
  double field_z_mm;
  double apex_side;  ///< +1 where the mirror's apex lies above the source, else -1
};

/// A point of a mirror that sends the ray of that angle where it must land.
struct CurvePoint {
  double angle_rad;  ///< at the source, from the direction to the apex
  double r_mm, z_mm;
  double slope_r, slope_z;  ///< derivatives by the angle, mm/rad
};

/// The mirror that a point source on the axis needs, from the apex at a given distance on: each ray is
/// reflected to where the flux balance puts it. Every apex distance gives another mirror with the same light.
/// @in    the apex distance from the source, > 0; angles to stop at, rising from above 0
/// @out   the apex and one point for each angle; a sentence instead where the curve runs away to infinity
/// @error relative 1e-9 of the curve
/// @cost  some hundred steps of eight evaluations
/// @from  the differential equation of a mirror under a given ray map, Elmer 1980; integrated by Dormand &
///        Prince's method of fifth order
std::variant<std::vector<CurvePoint>, std::string> tailored_curve(const FluxMap& map,
                                                                  const AxialLayout& layout, RayMap kind,
                                                                  double apex_distance_mm,
                                                                  const std::vector<double>& angles_rad);

}  // namespace catoptric::design
