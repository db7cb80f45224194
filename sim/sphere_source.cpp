#include "sim/sphere_source.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "sim/frame.h"
#include "sim/projection_map.h"

namespace catoptric::sim {
LambertianSphere::LambertianSphere(const Vector3& center_mm, double radius_mm, double power_w)
    : LambertianSurface(center_mm, Vector3::UnitZ(), power_w), radius_mm_(radius_mm) {
  require_size(radius_mm, "radius");
}

double LambertianSphere::intensity_w_per_sr(const Vector3&) const { return power_w() / (4 * pi); }

std::string LambertianSphere::words() const {
  return fmt::format("a Lambertian sphere of radius {:g} mm", radius_mm_);
}

Emitter LambertianSphere::emitter() const { return {center_mm(), radius_mm_, {}, Vector3::UnitZ(), false}; }

LambertianSurface::Place LambertianSphere::place(double first, double second) const {
  const double z = 1 - 2 * first, r = std::sqrt(std::max(0.0, (1 - z) * (1 + z)));
  const Vector3 outwards(r * std::cos(2 * pi * second), r * std::sin(2 * pi * second), z);
  return {center_mm() + radius_mm_ * outwards, outwards};
}

Ray LambertianSphere::emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const {
  const Vector3 direction = map.direction(numbers[0], numbers[1]);
  const Eigen::Matrix3d about = frame_about(direction);
  const double r = std::sqrt(numbers[2]), height = std::sqrt(1 - numbers[2]), turn = 2 * pi * numbers[3];
  return {center_mm() + radius_mm_ * (about * Vector3(r * std::cos(turn), r * std::sin(turn), height)),
          direction};
}

double LambertianSphere::unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const {
  const Vector3 way = center_mm() - point_mm;
  const double distance_mm = way.norm(), exitance = power_w() / (4 * pi * radius_mm_) / radius_mm_;
  const double share = radius_mm_ / distance_mm;  // sine of the half angle it is seen under
  if (!(share < 1)) return 0;
  const double cosine = way.dot(normal) / distance_mm;
  if (cosine <= -share) return 0;
  if (cosine >= share) return exitance * cosine * share * share;
  const double sine = way.cross(normal).norm() / distance_mm;
  const double x = std::sqrt((1 - share) * (1 + share)) / share;
  const double y = std::clamp(-x * cosine / sine, -1.0, 1.0), root = sine * std::sqrt((1 - y) * (1 + y));
  const double factor = ((cosine * std::acos(y) - x * root) * share * share + std::atan(root / x)) / pi;
  return exitance * std::max(0.0, factor);
}

}  // namespace catoptric::sim
