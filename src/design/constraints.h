#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/profile.h"
#include "base/units.h"

namespace catoptric::design {

/// What a mirror must keep to, to fit in and to be made. Whatever is left out does not bind.
struct Constraints {
  std::optional<double> rim_radius_min_mm, rim_radius_max_mm;  ///< where the generatrix ends
  std::optional<double> height_max_mm;                         ///< extent along the axis
  std::optional<double> opening_min_mm;                        ///< no part is nearer to the axis
  std::optional<double> envelope_radius_mm, envelope_low_mm, envelope_high_mm;
  std::optional<double> curvature_radius_min_mm;  ///< of the generatrix, either way
  std::optional<double> draft_angle_min_rad;
  std::optional<double> wall_mm;
  bool wall_outside = true;
  /// Where light from a point on the axis lands on a plane across it; with it no folds are allowed.
  struct Landing {
    double source_z_mm, field_z_mm, size_mm;
  };
  std::optional<Landing> no_folds;
};

enum class Dimension { length, angle, share };

/// One constraint and how a mirror stands to it. Lengths in mm, angles in rad.
struct ConstraintState {
  std::string name;  ///< its key under `constraints`
  Dimension dimension;
  bool at_least;  ///< limit <= value is asked for, else value <= limit
  double value, limit;
  double violation;  ///< how far value is beyond the limit; 0 when it is met
  double scale;      ///< a violation of this size counts as one
  bool certified;    ///< value has a bound; false: found on many points, see profile_measures.h
};

/// All constraints that bind, in the order of their keys.
std::vector<ConstraintState> states(const Constraints& constraints, const Profile& profile);

/// Sum of the violations, each over its scale; 0 exactly when all constraints are met.
/// @cost  microseconds for lengths, some 20 us a span for curvature, draft, wall and folds
double violation(const Constraints& constraints, const Profile& profile);
double violation(std::span<const ConstraintState> states);

/// Objective of a mirror that breaks constraints: above that of every mirror that breaks none, and rising
/// with the violation, so that a search is led in.
/// @from  Deb 2000, an efficient constraint handling method for genetic algorithms
inline constexpr double infeasible_floor = 1e100;  // no irradiance comes near; its square is no overflow
inline double infeasible_objective(double violation) { return infeasible_floor * (1 + violation); }

/// A number of a state in the unit that people read: the scene's length, degrees, percent.
double shown(const ConstraintState& state, double number, LengthUnit unit);
std::string unit_of(const ConstraintState& state, LengthUnit unit);

/// Which constraints are broken and by how much, or that all are met; empty when nothing binds.
std::string sentence(std::span<const ConstraintState> states, LengthUnit unit);

}  // namespace catoptric::design
