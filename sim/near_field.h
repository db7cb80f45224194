#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/ray.h"
#include "sim/facet_field.h"
#include "sim/material.h"

namespace catoptric::sim {

/// A point where irradiance is asked for, on the side its normal looks to.
struct FieldSample {
  Vector3 point_mm;
  Vector3 normal;         ///< unit
  std::size_t field = 0;  ///< on the near field, or on the so-manieth of Surroundings::fields(), from 1
};

/// Where a ray meets the surface that a field is a patch of.
struct Arrival {
  double distance_mm;
  Vector2 plane_mm;  ///< surface coordinates
  bool from_front;
};

/// At most two, nearest first.
struct Arrivals {
  std::array<Arrival, 2> at;
  std::size_t count = 0;
  const Arrival* begin() const { return at.data(); }
  const Arrival* end() const { return at.data() + count; }
};

/// A patch that registers light: a disc or a rectangle, anywhere and at any tilt, or the side of a cylinder,
/// which unrolls into a rectangle, or facets (the faces of a file). Irradiance counts on the side its normal
/// looks to, of a cylinder inside or outside. Without a material it is invisible and only registers; with one
/// it is an object that absorbs, reflects and transmits.
class NearField {
 public:
  enum class Shape { disc, rectangle, cylinder, facets };

  /// @in    normal and `along` need not be unit; `along` (the first rectangle axis) is made perpendicular to
  ///        normal
  /// @fails InputError for a number that is not finite, a size that is not positive, a normal of no length,
  ///        `along` parallel to the normal, a material that gives more light than it gets
  static NearField disc(const Vector3& center_mm, const Vector3& normal, double radius_mm,
                        std::optional<Material> material = {});
  static NearField rectangle(const Vector3& center_mm, const Vector3& normal, const Vector3& along,
                             double width_mm, double height_mm, std::optional<Material> material = {});
  /// @in    lit_inside: the front is the side towards the axis
  static NearField cylinder(const Vector3& center_mm, const Vector3& axis, double radius_mm, double length_mm,
                            bool lit_inside, std::optional<Material> material = {});
  /// Its surface coordinates are those of FacetField's sheet.
  static NearField facets(std::shared_ptr<const FacetField> facets, std::optional<Material> material = {});

  /// About `count` points spread uniformly by area, the same every time: exactly `count` on a disc (sunflower
  /// spiral) or facets (FacetField::places), on a rectangle or an unrolled cylinder the centres of a grid of
  /// nearly square cells, as near to `count` as they come.
  /// No point lies on the edge, none in the centre of a disc.
  /// @from  Vogel 1979 for the spiral
  std::vector<FieldSample> samples(std::size_t count) const;

  Shape shape() const { return shape_; }
  const Vector3& center_mm() const { return center_mm_; }
  const Vector3& normal() const { return normal_; }  ///< of a cylinder its axis
  const Vector3& first_axis() const { return first_axis_; }
  const Vector3& second_axis() const { return second_axis_; }
  /// The radius of a disc, half a cylinder's girth, of facets half the side of a square of their area.
  double half_width_mm() const { return half_width_mm_; }
  double half_height_mm() const { return half_height_mm_; }  ///< likewise of a disc and facets
  /// Null of other shapes.
  const FacetField* facets() const { return facets_.get(); }
  const std::optional<Material>& material() const { return material_; }
  double area_mm2() const;

  /// The normal of the front there.
  Vector3 front_at(const Vector2& plane_mm) const;
  /// Whether the sample looks to the front.
  bool looks_to_front(const FieldSample& sample) const {
    if (shape_ == Shape::facets) return true;  // there are no others
    return sample.normal.dot(shape_ == Shape::cylinder ? front_at(to_plane(sample.point_mm)) : normal_) > 0;
  }

  /// Meetings with the whole plane, or of a cylinder with its side between its ends, no farther than
  /// reach_mm. Of facets the nearest alone: a caller that wants all asks on from there.
  /// @in    starts_here: the ray starts on this surface, and does not meet it there again
  Arrivals meet(const Ray& ray, bool starts_here, double reach_mm) const;

  /// Surface coordinates about the centre, mm: those of the plane, or of a cylinder the way round it and that
  /// along its axis. Facets are not asked this.
  Vector2 to_plane(const Vector3& point_mm) const;
  /// The point with these coordinates.
  Vector3 to_space(const Vector2& plane_mm) const;
  /// Whether these coordinates lie on the patch itself.
  bool contains(const Vector2& plane_mm) const;

 private:
  NearField() = default;
  Shape shape_ = Shape::disc;
  Vector3 center_mm_, normal_, first_axis_, second_axis_;
  double half_width_mm_ = 0, half_height_mm_ = 0;
  double radius_mm_ = 0;     ///< of a cylinder
  bool lit_inside_ = false;  ///< of a cylinder
  std::shared_ptr<const FacetField> facets_;
  std::optional<Material> material_;
};

}  // namespace catoptric::sim
