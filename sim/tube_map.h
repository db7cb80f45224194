#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/axial_light.h"
#include "sim/tube_trace.h"

namespace catoptric::sim {

/// How the weight of rays goes over a tube, where the mirror's reflectance goes with the angle: as a share of
/// the greatest of three, the parabola through them.
struct WeightCourse {
  bool level = true;
  std::array<double, 3> share = {1, 0, 0};  ///< sum share[k] x^k over x in [-1, 1]
  double off = 0;                           ///< how far that may be off

  double at(double x) const { return share[0] + x * (share[1] + x * share[2]); }
  double slope(double x) const { return share[1] + 2 * x * share[2]; }
  /// The part about `centre` of half width `half`.
  WeightCourse part(double centre, double half) const {
    return {level, {at(centre), half * slope(centre), half * half * share[2]}, off};
  }
  /// Through weights at -1, 0, 1 that are `off` by so much between them.
  static WeightCourse through(double first, double middle, double last, double off) {
    if (first == middle && middle == last) return {};
    const double most = std::max({first, middle, last});
    return {false,
            {middle / most, 0.5 * (last - first) / most, (0.5 * (first + last) - middle) / most},
            off / most};
  }
};
/// Of the misfit of three rays' parabola at the quarters, what the parabolas of the halves are counted to be
/// off by: an eighth is left where the weight is smooth, a third where it has a bend.
inline constexpr double weight_misfit_counted = 0.5;

/// A tube of light: the emission angles between two rays of one path, with their landing radius between as
/// the quintic through the radii and derivatives of both rays and of a third in the middle.
struct Tube {
  double first_rad, last_rad;  ///< emission angle
  double rho[6];               ///< signed landing radius, sum rho[k] x^k over x in [-1, 1], mm
  double begin_mm, end_mm;     ///< at -1 and 1, the rays' own numbers
  double off_mm, off_slope;    ///< how far the quintic and its derivative by x may be off, mm
  double weight;               ///< the greatest of its rays'
  std::uint64_t path;
  WeightCourse course = {};
  double at(double x) const {
    return rho[0] + x * (rho[1] + x * (rho[2] + x * (rho[3] + x * (rho[4] + x * rho[5]))));
  }
  double slope(double x) const {
    return rho[1] + x * (2 * rho[2] + x * (3 * rho[3] + x * (4 * rho[4] + x * 5 * rho[5])));
  }
  double curve(double x) const { return 2 * rho[2] + x * (6 * rho[3] + x * (12 * rho[4] + x * 20 * rho[5])); }
  double half_width_rad() const { return 0.5 * (last_rad - first_rad); }
  double theta_rad(double x) const { return 0.5 * (first_rad + last_rad) + x * half_width_rad(); }
};

/// Values and derivatives by x of three rays at -1, 0, 1, as the quintic through them.
struct Hermite {
  double first, middle, last, d_first, d_middle, d_last;
  void quintic(double (&c)[6]) const {
    const double even = 0.5 * (first + last) - middle, turn = 0.5 * (d_last - d_first);
    const double odd = 0.5 * (last - first) - d_middle, rise = 0.5 * (d_first + d_last) - d_middle;
    c[0] = middle;
    c[1] = d_middle;
    c[2] = 2 * even - 0.5 * turn;
    c[4] = 0.5 * turn - even;
    c[5] = 0.5 * rise - 1.5 * odd;
    c[3] = odd - c[5];
  }
};

/// What the tubes are for, which decides where they are refined.
struct TubeGoal {
  double r_max_mm;             ///< largest radius asked for
  double kernel_radius_mm;     ///< 0: the pointwise field
  double tolerance_w_per_mm2;  ///< of the smoothed field
  int most_rays;               ///< fewer by up to 13 may be used, since rays come several at a time
  long most_meetings;          ///< of all rays with the mirror: in a cavity one ray may cost a thousand
};

/// The tubes between rays from a point on the axis, refined where the error is.
struct TubeMap {
  std::vector<Tube> tubes;
  double error_w_per_mm2 = 0;  ///< bound of the smoothed field's error by the tubes' quintics and by what
                               ///< lies between the last two rays of different paths
  double landed_w = 0;         ///< power of all landings on the plane, each meeting counted
  double cut_off_w = 0;        ///< power on paths stopped after the most interactions
  int rays = 0;
};

/// @in    breaks: emission angles between which the first surface met is one smooth piece, from 0 to pi or
///        where the light ends
/// @error an interval's five rays make two tubes of three; the rays at its quarters tell how far the quintic
///        of the other three is off. The two tubes are off by a sixty-fourth of it, a sixteenth is counted.
///        The kernel's steepest slope turns it into irradiance. Between two rays on different paths all
///        power counts at the kernel's peak
/// @from  Jacobsen 2001 for the use of ray derivatives; bound by the remainder of Hermite interpolation
TubeMap make_tubes(const TubeTracer& tracer, const std::vector<double>& breaks, const AxialLight& light,
                   const TubeGoal& goal);

/// Emission angles at which rays from (0, source_z) meet a knot, an end of the generatrix, or its outline as
/// seen from there, with 0 and pi; ascending.
std::vector<double> emission_breaks(const Profile& profile, double source_z_mm);

}  // namespace catoptric::sim
