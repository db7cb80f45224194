#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "base/profile.h"
#include "base/units.h"
#include "optim/problem.h"

namespace catoptric::design {

/// What a free profile may do.
struct FreeProfileOptions {
  LengthUnit unit = LengthUnit::millimetre;  ///< of the variables that are lengths
  /// Package that all control points stay in, so that the curve does; what is left out is half of the base's
  /// extent beyond the base. r is never negative.
  std::optional<double> r_greatest_mm, z_least_mm, z_greatest_mm;
  bool hold_vertex = false;      ///< z0 stays
  double length_step_rel = 0.1;  ///< first step of a length over the generatrix' extent: the paper's 1 cm
  double log_weight_step = 0.5;
  /// Weights stay within these times the first one, the paper's bounds; wider where the base is.
  double least_weight_rel = 0.05, greatest_weight_rel = 20;
};

/// Options whose package is the default one about `base`, written out, so that it stays when the profile does
/// not.
FreeProfileOptions package_about(const Profile& base, LengthUnit unit);

/// A whole generatrix as a design vector without directions that leave the shape as it is.
///
/// Of paper eq. 6 there is left out: r_0, and with r_0 = 0 and z_1 = z_0 (a smooth vertex) z_1, which moves
/// with z_0. Weights enter by their logarithm, since only their ratios mean something, less those that a
/// change of scale or of parameter makes up for: the first; and the last one of each stretch between knots of
/// full multiplicity (ends and kinks) that is a single span, whose weights w_j c^j mean the same curve at
/// another speed. A stretch of several spans allows no such change, because it would move the knots. So the
/// paper's nine dimensions of three points of degree 2 are the five z0, r1, logw1, r2, z2.
/// @error where the base is of a lower degree than it is written in (degree elevation), common factors of
///        numerator and denominator are flat to first order at the base itself
/// @from  Patterson 1985 (projective transformations of the parameter of a Bezier curve); The NURBS Book,
///        2nd ed., section 6.4
class FreeProfile {
 public:
  /// @in    base clamped at both ends
  /// @fails InputError for a base that is not, or that does not lie in the package
  FreeProfile(Profile base, const FreeProfileOptions& options);

  /// z0, r1, z1, logw1, ... in the order of eq. 6, starting at the base.
  std::vector<optim::Variable> variables() const;

  /// The profile with these values, or nothing when they are no generatrix. The start gives the base, to the
  /// roundings of unit and logarithm.
  /// @in values as many as variables
  std::optional<Profile> at(std::span<const double> values) const;

  /// Derivatives of the components of eq. 6 (r_0, z_0, w_0, r_1, ... in mm and plain weights; rows) by the
  /// variables (columns) at a profile of this family, so that sim::TubesJacobian::by_variable * chain() is
  /// the field's derivative by the variables.
  Eigen::MatrixXd chain(const Profile& profile) const;

  const Profile& base() const { return base_; }

 private:
  enum class Kind { r, z, log_weight };
  struct Freedom {
    Kind kind;
    std::size_t point;
  };
  optim::Variable variable(const Freedom& freedom) const;

  Profile base_;
  FreeProfileOptions options_;
  double unit_mm_;
  double extent_mm_ = 0;  ///< of the generatrix
  bool smooth_vertex_ = false;
  std::vector<Freedom> freedoms_;
};

}  // namespace catoptric::design
