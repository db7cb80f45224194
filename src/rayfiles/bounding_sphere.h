#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/ray.h"

namespace catoptric::rayfiles {

struct Sphere {
  Vector3 centre_mm = Vector3::Zero();
  double radius_mm = 0;
};

/// Keeps of a stream of points the two farthest along each of 13 directions: the axes, the diagonals of a
/// cube's faces, and those of its body. Two bounding boxes' worth of memory for any number of points.
/// @from  Larsson 2008, Fast and tight fitting bounding spheres (EPOS-26)
class ExtremePoints {
 public:
  void add(const Vector3& point_mm);
  bool empty() const { return !lowest_[0]; }

  /// The centre of the smallest sphere around the points kept. For the sphere around all points take the
  /// farthest of them from here.
  /// @in    at least one point was added
  /// @out   the sphere around all points is then at most some percent larger than the smallest
  /// @from  Badoiu & Clarkson 2003, Smaller core-sets for balls: steps towards the farthest, each shorter
  Vector3 centre_mm() const;

  const Vector3& lowest_mm(std::size_t axis) const { return lowest_[axis]->point_mm; }
  const Vector3& highest_mm(std::size_t axis) const { return highest_[axis]->point_mm; }

 private:
  struct Extreme {
    double along;
    Vector3 point_mm;
  };
  std::array<std::optional<Extreme>, 13> lowest_, highest_;
};

}  // namespace catoptric::rayfiles
