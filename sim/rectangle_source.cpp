#include "sim/rectangle_source.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "base/errors.h"
#include "base/float_traps.h"
#include "base/units.h"
#include "sim/projection_map.h"

namespace catoptric::sim {
namespace {

/// The part of a polygon on the side where `height` is positive.
/// @from  Sutherland & Hodgman 1974
std::vector<Vector3> part_before(const std::vector<Vector3>& polygon, const Vector3& normal) {
  std::vector<Vector3> part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = a.dot(normal), at_b = b.dot(normal);
    if (at_a >= 0) part.push_back(a);
    if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) part.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return part;
}

}  // namespace

LambertianRectangle::LambertianRectangle(const Vector3& center_mm, const Vector3& normal,
                                         const Vector3& along, double width_mm, double height_mm,
                                         double power_w)
    : LambertianSurface(center_mm, normal, power_w),
      area_mm2_(width_mm * height_mm),
      half_diagonal_mm_(0.5 * std::hypot(width_mm, height_mm)),
      width_mm_(width_mm),
      height_mm_(height_mm) {
  require_size(width_mm, "width");
  require_size(height_mm, "height");
  const UntrappedFloats untrapped;  // what has no direction is refused
  const Vector3 axis = frame().col(2), straight = along.stableNormalized();
  const Vector3 across = straight - straight.dot(axis) * axis;
  constexpr double least = 1e-9;  // rad between the two directions
  if (!(across.norm() > least))
    throw InputError({"the direction of the rectangle's width is none in its plane", "source",
                      "it must not be zero or along the normal", "[1, 0, 0] under a normal along z"});
  half_width_ = 0.5 * width_mm * across.normalized();
  half_height_ = 0.5 * height_mm * axis.cross(across.normalized());
}

double LambertianRectangle::intensity_w_per_sr(const Vector3& direction) const {
  return power_w() / pi * CosineLaw::lambert()(direction.dot(frame().col(2)));
}

std::string LambertianRectangle::words() const {
  return fmt::format("a Lambertian rectangle of {:g} by {:g} mm, lit on the side of its normal", width_mm_,
                     height_mm_);
}

Emitter LambertianRectangle::emitter() const {
  return {center_mm(), half_diagonal_mm_, CosineLaw::lambert(), frame().col(2)};
}

LambertianSurface::Place LambertianRectangle::place(double first, double second) const {
  return {center_mm() + (2 * first - 1) * half_width_ + (2 * second - 1) * half_height_, frame().col(2)};
}

Ray LambertianRectangle::emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const {
  return {place(numbers[2], numbers[3]).point_mm, map.direction(numbers[0], numbers[1])};
}

double LambertianRectangle::unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const {
  const Vector3 to_center = center_mm() - point_mm;
  if (!(to_center.dot(frame().col(2)) < 0)) return 0;  // behind the rectangle, or in its plane
  const std::vector<Vector3> seen =
      part_before({to_center - half_width_ - half_height_, to_center - half_width_ + half_height_,
                   to_center + half_width_ + half_height_, to_center + half_width_ - half_height_},
                  normal);
  double sum = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Vector3 &a = seen[i], &b = seen[(i + 1) % seen.size()];
    const Vector3 across = a.cross(b);
    const double sine = across.norm();
    if (sine > 0) sum += std::atan2(sine, a.dot(b)) / sine * across.dot(normal);
  }
  return power_w() / area_mm2_ * std::max(0.0, sum) / (2 * pi);
}

}  // namespace catoptric::sim
