#include "sim/object_shapes.h"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.h"
#include "base/float_traps.h"
#include "base/units.h"
#include "sim/frame.h"
#include "sim/ray_roots.h"

namespace catoptric::sim {
namespace {

void require_length(double length_mm, const char* what) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (!(std::isfinite(length_mm) && length_mm > 0))
    throw InputError({fmt::format("{} of {} mm", what, length_mm), "object",
                      "a size is finite and greater than 0", "give it a positive length"});
}

void require_place(const Vector3& center_mm, const Vector3& axis) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (!center_mm.allFinite() || !axis.allFinite() || axis.isZero(0))
    throw InputError({"an object has no place or direction", "object",
                      "coordinates are finite, and an axis is not zero", "[0, 0, 1] looks upwards"});
}

constexpr double out_of_round = 1e-9;

bool is_on_axis(const Vector3& center_mm, double size_mm) {
  return center_mm.head<2>().norm() <= out_of_round * size_mm;
}

/// @in  unit
bool is_along_axis(const Vector3& direction) { return direction.head<2>().norm() <= out_of_round; }

/// Where a ray meets a plane, if that is ahead and near enough.
std::optional<double> plane_distance(const Ray& ray, const Vector3& center_mm, const Vector3& normal,
                                     double reach_mm) {
  const double height_mm = (ray.origin_mm - center_mm).dot(normal), climb = ray.direction.dot(normal);
  if (!(height_mm * climb < 0)) return std::nullopt;
  const double distance_mm = -height_mm / climb;
  if (!(distance_mm <= reach_mm)) return std::nullopt;
  return distance_mm;
}

class Disc final : public SurfaceShape {
 public:
  Disc(const Vector3& center_mm, const Vector3& normal, double radius_mm, double inner_radius_mm)
      : center_mm_(center_mm),
        normal_(normal.stableNormalized()),
        outer_square_(radius_mm * radius_mm),
        inner_square_(inner_radius_mm * inner_radius_mm) {}

  std::optional<Meeting> meet(const Ray& ray, bool starts_here, double reach_mm) const override {
    if (starts_here) return std::nullopt;
    const auto distance_mm = plane_distance(ray, center_mm_, normal_, reach_mm);
    if (!distance_mm) return std::nullopt;
    const double square = (ray.origin_mm + *distance_mm * ray.direction - center_mm_).squaredNorm();
    if (square > outer_square_ || square < inner_square_) return std::nullopt;
    return Meeting{*distance_mm, normal_};
  }

  bool is_round() const override {
    return is_on_axis(center_mm_, std::sqrt(outer_square_)) && is_along_axis(normal_);
  }

 private:
  Vector3 center_mm_, normal_;
  double outer_square_, inner_square_;
};

class Rectangle final : public SurfaceShape {
 public:
  Rectangle(const Vector3& center_mm, const Eigen::Matrix3d& frame, double width_mm, double height_mm)
      : center_mm_(center_mm),
        frame_(frame),
        half_width_mm_(0.5 * width_mm),
        half_height_mm_(0.5 * height_mm) {}

  std::optional<Meeting> meet(const Ray& ray, bool starts_here, double reach_mm) const override {
    if (starts_here) return std::nullopt;
    const auto distance_mm = plane_distance(ray, center_mm_, frame_.col(2), reach_mm);
    if (!distance_mm) return std::nullopt;
    const Vector3 offset_mm = ray.origin_mm + *distance_mm * ray.direction - center_mm_;
    if (std::abs(offset_mm.dot(frame_.col(0))) > half_width_mm_ ||
        std::abs(offset_mm.dot(frame_.col(1))) > half_height_mm_)
      return std::nullopt;
    return Meeting{*distance_mm, frame_.col(2)};
  }

 private:
  Vector3 center_mm_;
  Eigen::Matrix3d frame_;
  double half_width_mm_, half_height_mm_;
};

class Tube final : public SurfaceShape {
 public:
  Tube(const Vector3& center_mm, const Vector3& axis, double radius_mm, double length_mm)
      : center_mm_(center_mm),
        frame_(frame_about(axis)),
        radius_mm_(radius_mm),
        half_length_mm_(0.5 * length_mm) {}

  std::optional<Meeting> meet(const Ray& ray, bool starts_here, double reach_mm) const override {
    const Vector3 from = frame_.transpose() * (ray.origin_mm - center_mm_);
    const Vector3 way = frame_.transpose() * ray.direction;
    const Vector2 across = from.head<2>(), step = way.head<2>();
    const double c = across.squaredNorm() - radius_mm_ * radius_mm_;
    for (const double t : ray_roots(step.squaredNorm(), across.dot(step), c, starts_here)) {
      if (!(t > 0 && t <= reach_mm && t < HUGE_VAL)) continue;
      if (std::abs(from.z() + t * way.z()) > half_length_mm_) continue;
      const Vector2 at = across + t * step;
      return Meeting{t, (frame_.leftCols<2>() * at).normalized()};
    }
    return std::nullopt;
  }

  bool is_round() const override {
    return is_on_axis(center_mm_, radius_mm_) && is_along_axis(frame_.col(2));
  }

 private:
  Vector3 center_mm_;
  Eigen::Matrix3d frame_;
  double radius_mm_, half_length_mm_;
};

class Cap final : public SurfaceShape {
 public:
  Cap(const Vector3& center_mm, const Vector3& axis, double radius_mm, double half_angle_rad,
      SphereFront front)
      : center_mm_(center_mm),
        axis_(axis.stableNormalized()),
        radius_mm_(radius_mm),
        least_cosine_(half_angle_rad < pi ? std::cos(half_angle_rad) : -HUGE_VAL),
        sign_(front == SphereFront::outside ? 1 : -1) {}

  std::optional<Meeting> meet(const Ray& ray, bool starts_here, double reach_mm) const override {
    const Vector3 from = ray.origin_mm - center_mm_;
    const double c = from.squaredNorm() - radius_mm_ * radius_mm_;
    for (const double t : ray_roots(1, from.dot(ray.direction), c, starts_here)) {
      if (!(t > 0 && t <= reach_mm && t < HUGE_VAL)) continue;
      const Vector3 outwards = (from + t * ray.direction).normalized();
      if (outwards.dot(axis_) < least_cosine_) continue;
      return Meeting{t, sign_ * outwards};
    }
    return std::nullopt;
  }

  bool is_round() const override {
    const bool whole = least_cosine_ == -HUGE_VAL;
    return is_on_axis(center_mm_, radius_mm_) && (whole || is_along_axis(axis_));
  }

 private:
  Vector3 center_mm_, axis_;
  double radius_mm_, least_cosine_, sign_;
};

}  // namespace

ShapePointer make_disc(const Vector3& center_mm, const Vector3& normal, double radius_mm,
                       double inner_radius_mm) {
  require_place(center_mm, normal);
  require_length(radius_mm, "radius");
  if (!(inner_radius_mm >= 0 && inner_radius_mm < radius_mm))
    throw InputError({fmt::format("a ring from {} to {} mm", inner_radius_mm, radius_mm), "object",
                      "its inner radius is at least 0 and less than its outer one", "swap them"});
  return std::make_shared<Disc>(center_mm, normal, radius_mm, inner_radius_mm);
}

ShapePointer make_rectangle(const Vector3& center_mm, const Vector3& normal, const Vector3& along,
                            double width_mm, double height_mm) {
  require_place(center_mm, normal);
  require_length(width_mm, "width");
  require_length(height_mm, "height");
  return std::make_shared<Rectangle>(center_mm, frame_along(normal, along), width_mm, height_mm);
}

ShapePointer make_tube(const Vector3& center_mm, const Vector3& axis, double radius_mm, double length_mm) {
  require_place(center_mm, axis);
  require_length(radius_mm, "radius");
  require_length(length_mm, "length");
  return std::make_shared<Tube>(center_mm, axis, radius_mm, length_mm);
}

ShapePointer make_cap(const Vector3& center_mm, const Vector3& axis, double radius_mm, double half_angle_rad,
                      SphereFront front) {
  require_place(center_mm, axis);
  require_length(radius_mm, "radius");
  if (!(half_angle_rad > 0 && half_angle_rad <= pi))
    throw InputError({fmt::format("a cap of {:.4g} degrees", half_angle_rad * 180 / pi), "object",
                      "its half angle is above 0 and at most 180 degrees", "90 is half a sphere"});
  return std::make_shared<Cap>(center_mm, axis, radius_mm, half_angle_rad, front);
}

}  // namespace catoptric::sim
