#include "sim/object_shapes.h"

#include <fmt/format.h>

#include <algorithm>
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

using Lines = std::vector<std::vector<Vector3>>;

/// A stretch of a circle about the third column of a frame.
std::vector<Vector3> arc(const Vector3& center_mm, const Eigen::Matrix3d& frame, double radius_mm,
                         double from_rad = 0, double to_rad = 2 * pi) {
  constexpr int steps = 72;
  std::vector<Vector3> points;
  for (int i = 0; i <= steps; ++i) {
    const double angle = from_rad + (to_rad - from_rad) * i / steps;
    points.emplace_back(center_mm +
                        radius_mm * (std::cos(angle) * frame.col(0) + std::sin(angle) * frame.col(1)));
  }
  return points;
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

  Lines outlines() const override {
    const Eigen::Matrix3d frame = frame_about(normal_);
    Lines lines{arc(center_mm_, frame, std::sqrt(outer_square_))};
    if (inner_square_ > 0) lines.push_back(arc(center_mm_, frame, std::sqrt(inner_square_)));
    return lines;
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

  Lines outlines() const override {
    const Vector3 u = half_width_mm_ * frame_.col(0), v = half_height_mm_ * frame_.col(1);
    const Vector3 first = center_mm_ - u - v;
    return {{first, first + 2 * u, first + 2 * u + 2 * v, first + 2 * v, first}};
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

  Lines outlines() const override {
    const Vector3 up = half_length_mm_ * frame_.col(2);
    Lines lines{arc(center_mm_ - up, frame_, radius_mm_), arc(center_mm_ + up, frame_, radius_mm_)};
    for (const double side : {-1.0, 1.0})
      for (const int column : {0, 1}) {
        const Vector3 at = center_mm_ + side * radius_mm_ * frame_.col(column);
        lines.push_back({at - up, at + up});
      }
    return lines;
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

  /// Two arcs through the pole and the rim; of a whole sphere the equator.
  Lines outlines() const override {
    const Eigen::Matrix3d frame = frame_about(axis_);
    const double half_rad = is_whole() ? pi : std::acos(std::clamp(least_cosine_, -1.0, 1.0));
    Lines lines;
    for (const int column : {0, 1}) {
      Eigen::Matrix3d upright;
      upright << axis_, frame.col(column), frame.col(1 - column);
      lines.push_back(arc(center_mm_, upright, radius_mm_, -half_rad, half_rad));
    }
    const double height_mm = is_whole() ? 0 : radius_mm_ * least_cosine_;
    lines.push_back(arc(center_mm_ + height_mm * axis_, frame,
                        std::sqrt(std::max(0.0, radius_mm_ * radius_mm_ - height_mm * height_mm))));
    return lines;
  }

  bool is_round() const override {
    return is_on_axis(center_mm_, radius_mm_) && (is_whole() || is_along_axis(axis_));
  }

 private:
  bool is_whole() const { return least_cosine_ == -HUGE_VAL; }

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
