#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/ray.h"

namespace catoptric {

/// A pole of the generatrix in the meridian half-plane, with its weight (the paper's w_i and P_i).
struct ControlPoint {
  double r_mm;
  double z_mm;
  double weight;
  bool operator==(const ControlPoint&) const = default;
};

/// One knot span of the generatrix as a rational Bezier curve over s in [0, 1], in homogeneous coordinates.
/// Neighbouring spans share their common end bit for bit.
struct RationalSpan {
  double first;                ///< parameter at s = 0
  double last;                 ///< parameter at s = 1
  std::vector<double> rw, zw;  ///< weight times r, weight times z; degree + 1 Bernstein coefficients, mm
  std::vector<double> w;       ///< weights
  int degree() const { return static_cast<int>(w.size()) - 1; }
};

/// A point of the generatrix with its derivatives by the parameter.
struct MeridianPoint {
  double r_mm, z_mm;
  double dr, dz;    ///< first derivative, mm per parameter
  double ddr, ddz;  ///< second derivative
};

/// The generatrix: a rational B-spline (r, z)(u) in the half-plane r >= 0, revolved about the z axis.
/// Plain numbers, no CAD kernel. Immutable and safe to share.
/// @from  paper eq. 5; Piegl & Tiller, The NURBS Book, 2nd ed., ch. 4
class Profile {
 public:
  /// @in    degree 1 to 9; knots flat (repeated by multiplicity), non-decreasing, not always clamped,
  ///        points.size() + degree + 1 of them; points at least degree + 1, finite, weights within
  ///        [least_weight, greatest_weight]
  /// @fails InputError that names the broken rule (see find_defect)
  Profile(int degree, std::vector<double> knots, std::vector<ControlPoint> points);

  /// A single Bezier span over [0, 1] of degree points.size() - 1.
  static Profile bezier(std::vector<ControlPoint> points);

  /// Clamped knots over [0, 1] with equal spans.
  static std::vector<double> uniform_knots(int degree, std::size_t point_count);

  /// What keeps these numbers from being a generatrix, in words, or nothing. Checks the rules of the
  /// constructor and that the curve has length and stays on r >= 0.
  static std::optional<ErrorParts> find_defect(int degree, std::span<const double> knots,
                                               std::span<const ControlPoint> points);

  int degree() const { return degree_; }
  const std::vector<double>& knots() const { return knots_; }
  const std::vector<ControlPoint>& points() const { return points_; }
  const std::vector<RationalSpan>& spans() const { return spans_; }
  double first_parameter() const { return spans_.front().first; }
  double last_parameter() const { return spans_.back().last; }
  bool is_rational() const;

  /// Position and two derivatives at u; u outside the range is taken at the nearer end.
  MeridianPoint at(double u) const;

  double r_max_mm() const { return r_max_mm_; }
  double z_min_mm() const { return z_min_mm_; }
  double z_max_mm() const { return z_max_mm_; }
  /// Largest extent of the revolved part: the diagonal of its bounding box, bounds taken from subdivided
  /// hulls.
  double diagonal_mm() const;
  /// Length of the generatrix.  @error relative 1e-9
  double length_mm() const;
  /// Area of the revolved surface.  @error relative 1e-9
  double area_mm2() const;

  bool operator==(const Profile& other) const {
    return degree_ == other.degree_ && knots_ == other.knots_ && points_ == other.points_;
  }

 private:
  int degree_;
  std::vector<double> knots_;
  std::vector<ControlPoint> points_;
  std::vector<RationalSpan> spans_;
  double r_max_mm_ = 0, z_min_mm_ = 0, z_max_mm_ = 0;
};

/// Position and derivatives on one span at s in [0, 1], derivatives by s.
MeridianPoint evaluate(const RationalSpan& span, double s);

}  // namespace catoptric
