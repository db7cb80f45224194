#pragma once

#include <cstdint>
#include <vector>

#include "sim/tube_trace.h"

namespace catoptric::sim {

/// A tube of light: the emission angles between two rays of one path, with their landing radius between as
/// the cubic through both rays' radii and derivatives.
struct Tube {
  double first_rad, last_rad;  ///< emission angle
  double rho[4];               ///< signed landing radius, sum rho[k] t^k over t in [0, 1], mm
  double end_mm;               ///< at t = 1, the ray's own number
  double weight;
  std::uint64_t path;
  double at(double t) const { return rho[0] + t * (rho[1] + t * (rho[2] + t * rho[3])); }
  double slope(double t) const { return rho[1] + t * (2 * rho[2] + t * 3 * rho[3]); }
};

/// What the tubes are for, which decides where they are refined.
struct TubeGoal {
  double r_max_mm;             ///< largest radius asked for
  double kernel_radius_mm;     ///< 0: the pointwise field
  double tolerance_w_per_mm2;  ///< of the smoothed field
  int most_rays;
};

/// The tubes between rays from a point on the axis, refined where the error is.
struct TubeMap {
  std::vector<Tube> tubes;
  double error_w_per_mm2 = 0;  ///< bound of the smoothed field's error by the tubes' cubics and by what lies
                               ///< between the last two rays of different paths
  double landed_w = 0;         ///< power of all landings on the plane, each meeting counted
  double cut_off_w = 0;        ///< power on paths stopped after the most interactions
  int rays = 0;
};

/// @in    breaks: emission angles between which the first surface met is one smooth piece, from 0 to pi
/// @error each interval's middle ray tells how far the cubic without it is off; with it the error falls to a
///        sixteenth, and an eighth is counted. The kernel's steepest slope turns it into irradiance.
///        Intervals whose rays take different paths count with all their power at the kernel's peak
/// @from  Jacobsen 2001 for the use of ray derivatives; bound by the remainder of Hermite interpolation
TubeMap make_tubes(const TubeTracer& tracer, const std::vector<double>& breaks, double power_w,
                   const TubeGoal& goal);

/// Emission angles at which rays from (0, source_z) meet a knot, an end of the generatrix, or its outline as
/// seen from there, with 0 and pi; ascending.
std::vector<double> emission_breaks(const Profile& profile, double source_z_mm);

}  // namespace catoptric::sim
