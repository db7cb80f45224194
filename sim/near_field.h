#pragma once

#include <optional>
#include <vector>

#include "base/ray.h"
#include "sim/material.h"

namespace catoptric::sim {

/// A point where irradiance is asked for, on the side its normal looks to.
struct FieldSample {
  Vector3 point_mm;
  Vector3 normal;  ///< unit
};

/// A plane patch that registers light: a disc or a rectangle, anywhere and at any tilt. Irradiance counts on
/// the side its normal looks to. Without a material it is invisible and only registers; with one it is an
/// object that absorbs, reflects and transmits.
class NearField {
 public:
  enum class Shape { disc, rectangle };

  /// @in    normal and `along` need not be unit; `along` (the first rectangle axis) is made perpendicular to
  ///        normal
  /// @fails InputError for a number that is not finite, a size that is not positive, a normal of no length,
  ///        `along` parallel to the normal, a material that gives more light than it gets
  static NearField disc(const Vector3& center_mm, const Vector3& normal, double radius_mm,
                        std::optional<Material> material = {});
  static NearField rectangle(const Vector3& center_mm, const Vector3& normal, const Vector3& along,
                             double width_mm, double height_mm, std::optional<Material> material = {});

  /// About `count` points spread uniformly by area, the same every time: exactly `count` on a disc (sunflower
  /// spiral), on a rectangle the centres of a grid of nearly square cells, as near to `count` as they come.
  /// No point lies on the edge, none in the centre of a disc.
  /// @from  Vogel 1979 for the spiral
  std::vector<FieldSample> samples(std::size_t count) const;

  Shape shape() const { return shape_; }
  const Vector3& center_mm() const { return center_mm_; }
  const Vector3& normal() const { return normal_; }
  const Vector3& first_axis() const { return first_axis_; }
  const Vector3& second_axis() const { return second_axis_; }
  double half_width_mm() const { return half_width_mm_; }    ///< the radius of a disc
  double half_height_mm() const { return half_height_mm_; }  ///< the radius of a disc
  const std::optional<Material>& material() const { return material_; }
  double area_mm2() const;

  /// Plane coordinates about the centre, mm.
  Vector2 to_plane(const Vector3& point_mm) const;
  /// The point with these plane coordinates.
  Vector3 to_space(const Vector2& plane_mm) const;
  /// Whether plane coordinates lie on the patch itself.
  bool contains(const Vector2& plane_mm) const;

 private:
  NearField() = default;
  Shape shape_ = Shape::disc;
  Vector3 center_mm_, normal_, first_axis_, second_axis_;
  double half_width_mm_ = 0, half_height_mm_ = 0;
  std::optional<Material> material_;
};

}  // namespace catoptric::sim
