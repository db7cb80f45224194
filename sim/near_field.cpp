#include "sim/near_field.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/contract.h"
#include "base/float_traps.h"
#include "base/units.h"
#include "sim/ray_roots.h"

namespace catoptric::sim {
namespace {

[[noreturn]] void refuse_field(std::string what, std::string why, std::string hint) {
  throw InputError({std::move(what), "near field", std::move(why), std::move(hint)});
}

void check_size(double size_mm, std::string_view name) {
  if (!(std::isfinite(size_mm) && size_mm > 0))
    refuse_field(fmt::format("{} of {} mm", name, size_mm), "a size is finite and greater than 0",
                 "give it a positive length");
}

void check_material(const std::optional<Material>& material) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (!material) return;
  if (auto defect = find_defect(*material)) {
    defect->where = "near field";
    throw InputError(std::move(*defect));
  }
}

Vector3 unit_normal(const Vector3& center_mm, const Vector3& normal) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (!center_mm.allFinite())
    refuse_field("the centre is not finite", "coordinates are finite numbers", "write three finite numbers");
  if (!normal.allFinite() || normal.isZero(0))
    refuse_field("the normal has no direction", "a normal is finite and not zero", "(0, 0, 1) looks upwards");
  return normal.stableNormalized();
}

/// The number of grid columns that brings columns x rows nearest to `count` with nearly square cells.
std::size_t grid_columns(std::size_t count, double width_over_height) {
  const auto rows_for = [count](std::size_t columns) {
    const double rows = std::round(static_cast<double>(count) / static_cast<double>(columns));
    return std::max<std::size_t>(1, static_cast<std::size_t>(rows));
  };
  const double ideal = std::sqrt(static_cast<double>(count) * width_over_height);
  const double most = static_cast<double>(count);
  std::size_t best = 1;
  double best_miss = HUGE_VAL;
  for (const double guess : {std::floor(ideal), std::ceil(ideal)}) {
    const auto columns = static_cast<std::size_t>(std::clamp(guess, 1.0, most));
    const double cells = static_cast<double>(columns) * static_cast<double>(rows_for(columns));
    const double miss = std::abs(cells - most);
    if (miss < best_miss) {
      best = columns;
      best_miss = miss;
    }
  }
  return best;
}

}  // namespace

NearField NearField::disc(const Vector3& center_mm, const Vector3& normal, double radius_mm,
                          std::optional<Material> material) {
  // Any first axis will do; the coordinate axis farthest from the normal among x and y keeps (x, y) for z.
  const Vector3 direction = unit_normal(center_mm, normal);
  const Vector3 along = std::abs(direction.x()) < 0.9 ? Vector3::UnitX() : Vector3::UnitY();
  check_size(radius_mm, "radius");
  NearField field = rectangle(center_mm, normal, along, radius_mm, radius_mm, material);
  field.shape_ = Shape::disc;
  field.half_width_mm_ = field.half_height_mm_ = radius_mm;
  return field;
}

NearField NearField::rectangle(const Vector3& center_mm, const Vector3& normal, const Vector3& along,
                               double width_mm, double height_mm, std::optional<Material> material) {
  NearField field;
  field.center_mm_ = center_mm;
  field.normal_ = unit_normal(center_mm, normal);
  check_size(width_mm, "width");
  check_size(height_mm, "height");
  check_material(material);
  if (!along.allFinite() || along.isZero(0))
    refuse_field("the first axis has no direction", "an axis is finite and not zero", "(1, 0, 0) is usual");
  const Vector3 unit_along = along.stableNormalized();
  const Vector3 in_plane = unit_along - unit_along.dot(field.normal_) * field.normal_;
  constexpr double least_sine = 1e-6;  // below it the in-plane part keeps fewer than ten digits
  if (in_plane.norm() < least_sine)
    refuse_field("the first axis is parallel to the normal", "it must have a part in the plane",
                 "choose another axis");
  field.first_axis_ = in_plane.normalized();
  field.second_axis_ = field.normal_.cross(field.first_axis_);
  field.shape_ = Shape::rectangle;
  field.half_width_mm_ = 0.5 * width_mm;
  field.half_height_mm_ = 0.5 * height_mm;
  field.material_ = material;
  return field;
}

NearField NearField::cylinder(const Vector3& center_mm, const Vector3& axis, double radius_mm,
                              double length_mm, bool lit_inside, std::optional<Material> material) {
  check_size(radius_mm, "radius");
  const Vector3 direction = unit_normal(center_mm, axis);
  const Vector3 along = std::abs(direction.x()) < 0.9 ? Vector3::UnitX() : Vector3::UnitY();
  NearField field = rectangle(center_mm, axis, along, 2 * pi * radius_mm, length_mm, material);
  field.shape_ = Shape::cylinder;
  field.radius_mm_ = radius_mm;
  field.lit_inside_ = lit_inside;
  return field;
}

NearField NearField::facets(std::shared_ptr<const FacetField> facets, std::optional<Material> material) {
  const double side_mm = std::sqrt(facets->area_mm2());
  NearField field =
      rectangle(Vector3::Zero(), Vector3::UnitZ(), Vector3::UnitX(), side_mm, side_mm, std::move(material));
  field.shape_ = Shape::facets;
  field.facets_ = std::move(facets);
  return field;
}

Vector3 NearField::front_at(const Vector2& plane_mm) const {
  if (shape_ == Shape::facets) return facets_->lit_normal(facets_->facet_at(plane_mm));
  if (shape_ != Shape::cylinder) return normal_;
  const double angle = plane_mm.x() / radius_mm_;
  const Vector3 outwards = std::cos(angle) * first_axis_ + std::sin(angle) * second_axis_;
  return lit_inside_ ? Vector3(-outwards) : outwards;
}

Arrivals NearField::meet(const Ray& ray, bool starts_here, double reach_mm) const {
  Arrivals arrivals;
  if (shape_ == Shape::facets) {
    if (const auto meeting = facets_->meet(ray, starts_here, reach_mm)) {
      const Vector3 at_mm = ray.origin_mm + meeting->distance_mm * ray.direction;
      arrivals.at[arrivals.count++] = {meeting->distance_mm, facets_->to_sheet(meeting->facet, at_mm),
                                       meeting->normal.dot(ray.direction) < 0};
    }
    return arrivals;
  }
  if (shape_ == Shape::cylinder) {
    const Vector3 from = ray.origin_mm - center_mm_;
    const Vector2 across{from.dot(first_axis_), from.dot(second_axis_)};
    const Vector2 step{ray.direction.dot(first_axis_), ray.direction.dot(second_axis_)};
    for (const double t : ray_roots(step.squaredNorm(), across.dot(step),
                                    across.squaredNorm() - radius_mm_ * radius_mm_, starts_here)) {
      if (!(t > 0 && t <= reach_mm && t < HUGE_VAL)) continue;
      const Vector2 at = across + t * step;
      const double height_mm = (from + t * ray.direction).dot(normal_);
      const bool from_inside = at.dot(step) > 0;
      arrivals.at[arrivals.count++] = {
          t, {radius_mm_ * std::atan2(at.y(), at.x()), height_mm}, from_inside == lit_inside_};
    }
    return arrivals;
  }
  if (starts_here) return arrivals;
  const double height_mm = (ray.origin_mm - center_mm_).dot(normal_);
  const double climb = ray.direction.dot(normal_);
  if (!(height_mm * climb < 0)) return arrivals;
  const double distance_mm = -height_mm / climb;
  if (!(distance_mm <= reach_mm)) return arrivals;
  arrivals.at[arrivals.count++] = {distance_mm, to_plane(ray.origin_mm + distance_mm * ray.direction),
                                   climb < 0};
  return arrivals;
}

std::vector<FieldSample> NearField::samples(std::size_t count) const {
  std::vector<FieldSample> samples;
  if (count == 0) return samples;
  if (shape_ == Shape::facets) {
    for (const auto& [point_mm, normal] : facets_->places(count)) samples.push_back({point_mm, normal});
    return samples;
  }
  const auto add = [&](double x, double y) { samples.push_back({to_space({x, y}), front_at({x, y})}); };
  if (shape_ == Shape::disc) {
    const double golden_angle = pi * (3 - std::sqrt(5.0));
    for (std::size_t i = 0; i < count; ++i) {
      const double index = static_cast<double>(i);
      const double r = half_width_mm_ * std::sqrt((index + 0.5) / static_cast<double>(count));
      const double angle = index * golden_angle;
      add(r * std::cos(angle), r * std::sin(angle));
    }
    return samples;
  }
  const std::size_t columns = grid_columns(count, half_width_mm_ / half_height_mm_);
  const auto rows = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::round(static_cast<double>(count) / static_cast<double>(columns))));
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const double x = (2 * static_cast<double>(column) + 1) / static_cast<double>(columns) - 1;
      const double y = (2 * static_cast<double>(row) + 1) / static_cast<double>(rows) - 1;
      add(x * half_width_mm_, y * half_height_mm_);
    }
  return samples;
}

double NearField::area_mm2() const {
  if (shape_ == Shape::facets) return facets_->area_mm2();
  return shape_ == Shape::disc ? pi * half_width_mm_ * half_width_mm_ : 4 * half_width_mm_ * half_height_mm_;
}

Vector2 NearField::to_plane(const Vector3& point_mm) const {
  CATOPTRIC_EXPECTS(shape_ != Shape::facets);
  const Vector3 offset = point_mm - center_mm_;
  if (shape_ == Shape::cylinder)
    return {radius_mm_ * std::atan2(offset.dot(second_axis_), offset.dot(first_axis_)), offset.dot(normal_)};
  return {offset.dot(first_axis_), offset.dot(second_axis_)};
}

Vector3 NearField::to_space(const Vector2& plane_mm) const {
  if (shape_ == Shape::facets) return facets_->to_space(plane_mm);
  if (shape_ == Shape::cylinder) {
    const double angle = plane_mm.x() / radius_mm_;
    return center_mm_ + radius_mm_ * (std::cos(angle) * first_axis_ + std::sin(angle) * second_axis_) +
           plane_mm.y() * normal_;
  }
  return center_mm_ + plane_mm.x() * first_axis_ + plane_mm.y() * second_axis_;
}

bool NearField::contains(const Vector2& plane_mm) const {
  if (shape_ == Shape::facets) return true;
  if (shape_ == Shape::disc) return plane_mm.squaredNorm() <= half_width_mm_ * half_width_mm_;
  return std::abs(plane_mm.x()) <= half_width_mm_ && std::abs(plane_mm.y()) <= half_height_mm_;
}

}  // namespace catoptric::sim
