#pragma once

#include <Eigen/Core>
#include <span>

#include "sim/tubes.h"

namespace catoptric::sim {

/// The smoothed field of ray tubes with its derivatives by the design vector.
struct TubesJacobian {
  TubesField field;
  Eigen::MatrixXd by_variable;   ///< W/mm^2 per mm or per unit of weight; a row for each radius asked for,
                                 ///< columns r_0, z_0, w_0, r_1, ... as in paper eq. 6
  double unmoved_w_per_mm2 = 0;  ///< irradiance at edges whose motion is left out (a mirror that passes the
                                 ///< near field's plane); 0: none
};

/// Derivatives of the reflected light by every coordinate and weight of the control points.
///
/// The computed sum is differentiated with the tubes' emission angles fixed: each tube's quintic moves as its
/// three rays' radii and slopes do, which follow from implicit differentiation at each hit; the kernel
/// vanishes at its edge, so the cuts there give nothing. Where a branch ends (rim, knot with a kink, outline,
/// shade by another part of the mirror) the edge of the light moves too: its brightness times that motion.
/// @in    as tubes_field, with a positive kernel radius and a mirror that does not transmit
/// @fails InputError otherwise
/// @error the derivative of the tubes' sum, which is the field's to about the tolerance
/// @cost  some 3 us a ray and bounce for each four control points; a radius as one of tubes_field that is not
///        interpolated, times three
TubesJacobian tubes_jacobian(const PointSource& source, const Profile& profile, const Material& mirror,
                             const FieldPlane& plane, std::span<const double> radii_mm,
                             const TubesOptions& options);

}  // namespace catoptric::sim
