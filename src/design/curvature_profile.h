#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/profile.h"
#include "base/units.h"
#include "optim/problem.h"

namespace catoptric::design {

struct CurvatureProfileOptions {
  int stations = 8;                          ///< curvatures at equal arc lengths, vertex and rim among them
  int degree = 3;                            ///< of the B-spline that stands for the curve, 3 to 9
  LengthUnit unit = LengthUnit::millimetre;  ///< of variables that are lengths; curvatures are per unit
  bool hold_vertex = false;                  ///< z0 stays
  double length_step_rel = 0.05, curvature_step_rel = 0.1, angle_step_rad = 0.05;
};

/// A generatrix given by its curvature: that is what bends light, and a change of it at one place leaves the
/// slopes before that place alone.
///
/// Variables: z0; angle0, the tangent's angle to the r axis at the vertex (none at a vertex on the axis that
/// is smooth); kappa0, kappa1, ... at equal shares of the arc length, linear between them (a clothoid each);
/// length. The first point's r is the base's. Slopes integrate in closed form, points by Gauss' rule. What a
/// reflector needs is a B-spline: one of the given degree, with a knot at every half station, is fitted to
/// the curve, both ends and both end directions exact.
/// @from  paper section 7, which proposes curvature-based variables
class CurvatureProfile {
 public:
  /// @fails InputError for a number of stations or a degree out of range
  CurvatureProfile(const Profile& base, const CurvatureProfileOptions& options);

  /// They start at the base: the curvatures are those whose slopes come nearest to its own.
  const std::vector<optim::Variable>& variables() const { return variables_; }

  /// The profile with these values, or nothing when they are no generatrix.
  std::optional<Profile> at(std::span<const double> values) const;

  /// Greatest distance of the fitted B-spline from the curve that the values mean, at points of equal arc
  /// length; infinite when they are no generatrix.
  double fit_error_mm(std::span<const double> values) const;

  /// Greatest distance of the start from the base, at equal shares of the arc length.
  double start_error_mm() const { return start_error_mm_; }

 private:
  struct Curve {  ///< the integrated curve at shares_
    std::vector<double> r_mm, z_mm;
    double first_angle = 0, last_angle = 0, length_mm = 0;
  };
  Curve integrated(std::span<const double> values) const;
  std::vector<ControlPoint> fitted(const Curve& curve) const;
  void prepare_fit();

  CurvatureProfileOptions options_;
  double unit_mm_, first_r_mm_, first_z_mm_, first_angle_ = 0;
  bool angle_free_;
  std::vector<optim::Variable> variables_;
  std::vector<double> knots_;           ///< over the share of the arc length
  std::vector<double> shares_;          ///< where the curve is compared
  Eigen::MatrixXd basis_;               ///< of the control points at the shares
  Eigen::LLT<Eigen::MatrixXd> normal_;  ///< of the inner control points
  double start_error_mm_ = 0;
};

}  // namespace catoptric::design
