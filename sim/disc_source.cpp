#include "sim/disc_source.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "base/units.h"
#include "sim/projection_map.h"

namespace catoptric::sim {
namespace {

/// Lambert's formula takes the angle under which each piece of the contour is seen, times how far its plane
/// turns to the normal.
/// @in    at: from the element to a place of the rim; step: its derivative by the angle
double rim_term(const Vector3& at, const Vector3& step, const Vector3& normal) {
  return at.cross(step).dot(normal) / at.squaredNorm();
}

}  // namespace

LambertianDisc::LambertianDisc(const Vector3& center_mm, double radius_mm, const Vector3& normal,
                               double power_w)
    : LambertianSurface(center_mm, normal, power_w), radius_mm_(radius_mm) {
  require_size(radius_mm, "radius");
}

double LambertianDisc::exitance() const { return power_w() / (pi * radius_mm_) / radius_mm_; }

double LambertianDisc::intensity_w_per_sr(const Vector3& direction) const {
  return power_w() / pi * CosineLaw::lambert()(direction.dot(frame().col(2)));
}

std::string LambertianDisc::words() const {
  return fmt::format("a Lambertian disc of radius {:g} mm, lit on the side of its normal", radius_mm_);
}

Emitter LambertianDisc::emitter() const {
  return {center_mm(), radius_mm_, CosineLaw::lambert(), frame().col(2)};
}

LambertianSurface::Place LambertianDisc::place(double first, double second) const {
  const double r_mm = radius_mm_ * std::sqrt(first);
  return {center_mm() + r_mm * std::cos(2 * pi * second) * frame().col(0) +
              r_mm * std::sin(2 * pi * second) * frame().col(1),
          frame().col(2)};
}

Ray LambertianDisc::emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const {
  return {place(numbers[2], numbers[3]).point_mm, map.direction(numbers[0], numbers[1])};
}

double LambertianDisc::unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const {
  // In the disc's frame and in its radii.
  const Vector3 local = frame().transpose() * (point_mm - center_mm()) / radius_mm_;
  const Vector3 facing = frame().transpose() * normal;
  if (!(local.z() > 0)) return 0;
  const double middle = -local.dot(facing), swing = facing.head<2>().norm();
  if (middle <= -swing) return 0;  // all of the disc is behind the element
  const double factor = middle >= swing ? of_whole(local, facing) : of_part(local, facing);
  return exitance() * std::max(0.0, factor);
}

/// The whole disc's configuration factor: that of an element parallel to it and that of one facing its axis,
/// which add up like the components of a vector. Differences of near numbers are multiplied out.
double LambertianDisc::of_whole(const Vector3& local, const Vector3& normal) const {
  const double h = local.z(), d = std::hypot(local.x(), local.y());
  const double root = std::hypot(h, d - 1) * std::hypot(h, d + 1);
  const double below = h * h + d * d - 1, above = h * h + d * d + 1;
  const double parallel = below > 0 ? 2 * h / (root + below) * (h / root) : 0.5 * (1 - below / root);
  const double across = 2 * h / (root + above) * (d / root);
  const double outwards = d > 0 ? (local.x() * normal.x() + local.y() * normal.y()) / d : 0;
  return -parallel * normal.z() - across * outwards;
}

/// Of the part of the disc before the element's plane: its rim is an arc, and a chord in that plane, which is
/// seen as an angle about the normal.
double LambertianDisc::of_part(const Vector3& local, const Vector3& normal) const {
  const double middle = -local.dot(normal), swing = normal.head<2>().norm();
  const double towards = std::atan2(normal.y(), normal.x());
  const double half = std::acos(std::clamp(-middle / swing, -1.0, 1.0));
  const auto at = [&](double angle) -> Vector3 {
    return Vector3(std::cos(towards + angle), std::sin(towards + angle), 0) - local;
  };
  const auto term = [&](double angle) {
    const Vector3 step(-std::sin(towards + angle), std::cos(towards + angle), 0);
    return rim_term(at(angle), step, normal);
  };
  constexpr double tolerance = 1e-10;
  constexpr unsigned deepest = 30;  // halvings for an element next to the rim
  double arc = 0;
  for (const double side : {-1.0, 1.0})
    arc += side * boost::math::quadrature::gauss_kronrod<double, 15>::integrate(term, 0.0, side * half,
                                                                                deepest, tolerance);
  const Vector3 first = at(-half), last = at(half);
  const double chord = std::atan2(last.cross(first).dot(normal), last.dot(first));
  // From the element's side the rim runs the other way round; the sign makes light positive.
  return std::abs(arc + chord) / (2 * pi);
}

}  // namespace catoptric::sim
