#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/profile.h"
#include "base/spline_basis.h"
#include "design/flux_map.h"
#include "design/tailored_curve.h"

namespace catoptric::design {

/// How far a mirror's rays miss the places that the flux balance gives them, as directions: for rays from the
/// source by way of fixed curve parameters, the reflected unit direction less that towards the landing point.
/// Unlike differences of irradiance these have no jumps, no folds and no places where nothing is felt.
class DirectionResiduals {
 public:
  /// @in the map must outlive this; so many rays, spread evenly over the parameter
  DirectionResiduals(const FluxMap& map, const AxialLayout& layout, RayMap kind, int degree,
                     std::vector<double> knots, std::size_t rays);

  std::size_t size() const { return 2 * rays_.size(); }

  /// @in    control points for the degree and knots
  /// @out   two residuals a ray, r and z, over the root of the number of rays; rad to first order
  ///        jacobian: by r_0, z_0, w_0, r_1, ... (paper eq. 6), per mm and per unit of weight; may be null
  /// @cost  some 0.2 us a ray
  void evaluate(std::span<const ControlPoint> points, std::span<double> residuals,
                Eigen::MatrixXd* jacobian) const;

 private:
  const FluxMap& map_;
  AxialLayout layout_;
  double side_;  ///< of the axis where light lands, seen from the mirror's half of the meridian
  std::vector<SplineBasis> rays_;
};

}  // namespace catoptric::design
