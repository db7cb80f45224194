#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/profile.h"
#include "design/flux_map.h"
#include "design/tailored_curve.h"
#include "optim/problem.h"

namespace catoptric::design {

/// Profiles of one degree and one set of knots that some numbers make.
struct ProfileVariables {
  std::vector<optim::Variable> variables;  ///< in a box; they start at the base
  /// Nothing where the numbers are no generatrix.
  std::function<std::optional<Profile>(std::span<const double>)> at;
  /// Derivatives of r_0, z_0, w_0, r_1, ... (rows; mm and plain weights) by the numbers (columns).
  std::function<Eigen::MatrixXd(const Profile&)> chain;
};

struct TailoringOptions {
  std::size_t fewest_rays = 64;
  std::size_t rays_a_point = 8;   ///< of the control points
  long most_evaluations = 60;     ///< of one start
  int most_restarts = 20;         ///< from other places in the box, while the miss is above `reach_rad`
  double reach_rad = 1e-8;        ///< a miss that needs no further start
  double value_tolerance = 1e-8;  ///< relative change of the squared miss that ends a start
};

/// A mirror whose rays go where the flux balance sends them, as nearly as its variables allow.
struct Tailored {
  Profile profile;
  std::vector<double> values;  ///< of the variables
  double miss_rad;             ///< root mean square over rays, as directions
  long evaluations;
  int starts;
};

/// Moves the variables until the rays of fixed curve parameters go where the flux balance puts them, and the
/// rim takes as much light as is wanted. Restarts begin at Halton's points of the box.
/// @in    a base that is a generatrix
/// @out   never a greater miss than the base's
/// @cost  a start takes 5 to 20 evaluations of some 0.3 us a ray, and half as much again for the linear
/// algebra
/// @from  Levenberg 1944, Marquardt 1963 on direction residuals (see DirectionResiduals)
Tailored tailor(const FluxMap& map, const AxialLayout& layout, RayMap kind, const ProfileVariables& family,
                const TailoringOptions& options = {});

}  // namespace catoptric::design
