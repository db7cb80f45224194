#include "sim/facet_field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors.h"

namespace catoptric::sim {
namespace {

// A facet takes the middle half of its cell, so that rounding puts no place into the next.
constexpr double cell_margin = 0.25, cell_share = 0.5;
constexpr double lift_of_size = 1e-5;  // a hundred times what meetings with facets are good for

}  // namespace

FacetField::FacetField(std::shared_ptr<const SurfaceShape> shape, std::shared_ptr<const Facets> facets,
                       bool lit_front)
    : shape_(std::move(shape)), facets_(std::move(facets)), side_(lit_front ? 1 : -1) {
  constexpr std::size_t most = 100'000'000;
  if (this->facets() > most)
    throw InputError({"too many facets", "field", "at most 1e8 are taken", "a greater chord_error"});
  double area_mm2 = 0;
  Vector3 least = Vector3::Constant(HUGE_VAL), greatest = -least;
  for (std::size_t i = 0; i < this->facets(); ++i) {
    const Vector3 across = (corner_mm(i, 1) - corner_mm(i, 0)).cross(corner_mm(i, 2) - corner_mm(i, 0));
    normals_.push_back(side_ * across.stableNormalized());
    area_mm2 += 0.5 * across.stableNorm();
    end_mm2_.push_back(area_mm2);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      least = least.cwiseMin(corner_mm(i, corner));
      greatest = greatest.cwiseMax(corner_mm(i, corner));
    }
  }
  if (!(area_mm2 > 0 && std::isfinite(area_mm2)))
    throw InputError({"its faces have no area", "field", "irradiance is asked for on an area",
                      "check the file and its unit"});
  lift_mm_ = lift_of_size * 0.5 * (greatest - least).norm();
  columns_ = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(this->facets()))));
}

std::optional<Meeting> FacetField::meet(const Ray& ray, bool starts_here, double reach_mm) const {
  auto meeting = shape_->meet(ray, starts_here, reach_mm);
  if (meeting) meeting->normal = normals_[meeting->facet];
  return meeting;
}

Vector2 FacetField::to_sheet(std::size_t facet, const Vector3& point_mm) const {
  const Vector3 first = corner_mm(facet, 1) - corner_mm(facet, 0),
                second = corner_mm(facet, 2) - corner_mm(facet, 0), at = point_mm - corner_mm(facet, 0);
  const Vector3 across = first.cross(second);
  const double square = across.squaredNorm();
  const auto share = [&](const Vector3& a, const Vector3& b) {
    return square > 0 ? std::clamp(a.cross(b).dot(across) / square, 0.0, 1.0) : 0.0;
  };
  const double u = share(at, second), v = std::min(share(first, at), 1 - u);
  return {static_cast<double>(facet % columns_) + cell_margin + cell_share * u,
          static_cast<double>(facet / columns_) + cell_margin + cell_share * v};
}

std::size_t FacetField::facet_at(const Vector2& sheet) const {
  return static_cast<std::size_t>(sheet.y()) * columns_ + static_cast<std::size_t>(sheet.x());
}

Vector3 FacetField::to_space(const Vector2& sheet) const {
  const std::size_t facet = facet_at(sheet);
  const double u = (sheet.x() - std::floor(sheet.x()) - cell_margin) / cell_share,
               v = (sheet.y() - std::floor(sheet.y()) - cell_margin) / cell_share;
  return corner_mm(facet, 0) + u * (corner_mm(facet, 1) - corner_mm(facet, 0)) +
         v * (corner_mm(facet, 2) - corner_mm(facet, 0));
}

std::vector<FacetField::Place> FacetField::places(std::size_t count) const {
  std::vector<Place> places;
  places.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double index = static_cast<double>(i);
    const double at_mm2 = area_mm2() * (index + 0.5) / static_cast<double>(count);
    const auto facet =
        std::min(static_cast<std::size_t>(std::ranges::upper_bound(end_mm2_, at_mm2) - end_mm2_.begin()),
                 facets() - 1);
    const double begin_mm2 = facet == 0 ? 0 : end_mm2_[facet - 1];
    const double within = std::clamp((at_mm2 - begin_mm2) / (end_mm2_[facet] - begin_mm2), 0.0, 1.0);
    const double golden = index * std::numbers::phi;
    // The part of the triangle's area that lies on one side of the way from a corner grows like the square.
    const double root = std::sqrt(within), across = golden - std::floor(golden);
    const Vector3 point_mm = (1 - root) * corner_mm(facet, 0) +
                             root * ((1 - across) * corner_mm(facet, 1) + across * corner_mm(facet, 2));
    places.push_back({point_mm + lift_mm_ * normals_[facet], normals_[facet]});
  }
  return places;
}

}  // namespace catoptric::sim
