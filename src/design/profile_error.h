#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/profile.h"

namespace catoptric::design {

/// A displacement of a generatrix' control points.
struct PointShift {
  double dr_mm, dz_mm;
};

/// How a made mirror may differ from the drawn one: its generatrix moved along the normal, by an amount that
/// is a function of the arc length. The mirror is refined without changing it until a spline of its own can
/// follow that function, whose control points then move in proportion.
class ProfileError {
 public:
  /// @fails as cad::elevated, cad::split_spans
  explicit ProfileError(const Profile& base);

  /// Displacements that move the curve by offset(share of arc length from the vertex) along the normal, away
  /// from the room that the generatrix encloses with the axis. A vertex on the axis stays on it.
  /// @in    offset: mm, or mm per unit of whatever amplitude at() is given
  /// @error an interpolation by cubics over a thirtieth of the length each: 1e-3 of offsets of up to four
  /// half
  ///        waves
  std::vector<PointShift> along_normal(const std::function<double(double share)>& offset) const;

  /// The mirror with its control points displaced `amplitude` times, or nothing when that is no generatrix.
  std::optional<Profile> at(const std::vector<PointShift>& shift, double amplitude) const;

  /// The undisturbed mirror as it is refined.
  const Profile& base() const { return base_; }
  double length_mm() const { return length_mm_; }

 private:
  Profile base_;
  std::vector<double> nodes_;   ///< parameters of interpolation, one per control point
  std::vector<double> shares_;  ///< of the arc length there
  double length_mm_ = 0;
};

}  // namespace catoptric::design
