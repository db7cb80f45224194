#include "sim/frame.h"

#include "base/errors.h"

namespace catoptric::sim {

Eigen::Matrix3d frame_along(const Vector3& axis, const Vector3& along) {
  Eigen::Matrix3d frame;
  frame.col(2) = axis.normalized();
  const Vector3 across = along - along.dot(frame.col(2)) * frame.col(2);
  constexpr double least_sine = 1e-9;  // below, roundings would turn it
  if (!(across.norm() > least_sine * along.norm()))
    throw InputError({"a second direction is none across the axis", "source",
                      "it must not be zero or along the axis", "[1, 0, 0] for an axis along z"});
  frame.col(0) = across.normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

}  // namespace catoptric::sim
