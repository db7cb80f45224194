#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/surface_shape.h"

namespace catoptric::sim {

/// A surface of facets where light is registered: the faces of a file.
///
/// Its surface coordinates lay the facets out in a square sheet, each in a cell of its own, by barycentric
/// coordinates: two numbers name a place on any facet, and neighbours in space need not be neighbours there.
class FacetField {
 public:
  /// @in    facets: those that `shape` names in its meetings; lit_front: light counts on the facets' front
  /// @fails InputError where the facets have no area, or are more than 1e8
  FacetField(std::shared_ptr<const SurfaceShape> shape, std::shared_ptr<const Facets> facets, bool lit_front);

  double area_mm2() const { return end_mm2_.back(); }
  std::size_t facets() const { return facets_->corners.size(); }

  /// The side that counts, unit.
  const Vector3& lit_normal(std::size_t facet) const { return normals_[facet]; }
  const Vector3& corner_mm(std::size_t facet, std::size_t corner) const {
    return facets_->corner_mm(facet, corner);
  }

  std::vector<std::vector<Vector3>> outlines() const { return facets_->outlines(); }

  /// The nearest meeting ahead; its normal is the lit one.
  std::optional<Meeting> meet(const Ray& ray, bool starts_here, double reach_mm) const;

  Vector2 to_sheet(std::size_t facet, const Vector3& point_mm) const;
  std::size_t facet_at(const Vector2& sheet) const;
  Vector3 to_space(const Vector2& sheet) const;

  struct Place {
    Vector3 point_mm, normal;
  };
  /// So many places uniform by area, a hundred-thousandth of the surface's size above the lit side, so that
  /// the surface does not shade them itself by rounding.
  /// Place i stands for the i-th of equal parts of the area, taken facet by facet.
  std::vector<Place> places(std::size_t count) const;

 private:
  std::shared_ptr<const SurfaceShape> shape_;
  std::shared_ptr<const Facets> facets_;
  std::vector<Vector3> normals_;
  std::vector<double> end_mm2_;  ///< the area of all facets up to this one
  std::size_t columns_ = 1;
  double side_;  ///< 1 where the front is lit, else -1
  double lift_mm_ = 0;
};

}  // namespace catoptric::sim
