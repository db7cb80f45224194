#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "base/ray.h"

namespace catoptric::sim {

/// A right-handed frame whose third column is the axis; the identity for +z.
inline Eigen::Matrix3d frame_about(const Vector3& axis) {
  Eigen::Matrix3d frame;
  frame.col(2) = axis.normalized();
  const Vector3 other = std::abs(frame(0, 2)) < 0.9 ? Vector3::UnitX() : Vector3::UnitY();
  frame.col(0) = (other - other.dot(frame.col(2)) * frame.col(2)).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

/// The same with its first column as near to `along` as can be.
/// @fails InputError when that is no direction across the axis
Eigen::Matrix3d frame_along(const Vector3& axis, const Vector3& along);

}  // namespace catoptric::sim
