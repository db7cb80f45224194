#pragma once

#include <memory>

#include "base/surface_shape.h"

namespace catoptric::sim {

using ShapePointer = std::shared_ptr<const SurfaceShape>;

// Surfaces with a formula. Meetings are roots of it; of a ray that starts on the surface one root is known to
// be its start, and only the other is looked at, so that no length must be left out before it. All fail with
// an InputError for numbers that are not finite, sizes that are not positive, axes of no length.

/// A flat disc, or with an inner radius above 0 a flat ring; its front is where `normal` looks to.
ShapePointer make_disc(const Vector3& center_mm, const Vector3& normal, double radius_mm,
                       double inner_radius_mm = 0);

/// A flat rectangle; `along`, made perpendicular to the normal, is the direction of its width.
ShapePointer make_rectangle(const Vector3& center_mm, const Vector3& normal, const Vector3& along,
                            double width_mm, double height_mm);

/// The side of a cylinder about `axis`; its front is outside.
ShapePointer make_tube(const Vector3& center_mm, const Vector3& axis, double radius_mm, double length_mm);

enum class SphereFront { outside, inside };

/// The part of a sphere within `half_angle_rad` of `axis` as seen from its centre: pi is all of it.
ShapePointer make_cap(const Vector3& center_mm, const Vector3& axis, double radius_mm, double half_angle_rad,
                      SphereFront front = SphereFront::outside);

}  // namespace catoptric::sim
