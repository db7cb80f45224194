#include "sim/cylinder_source.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <vector>

#include "base/units.h"
#include "sim/projection_map.h"

namespace catoptric::sim {
namespace {

/// Integrals over h from `low` to `high` of 1 / (a^2 + h^2)^2 and of h / (a^2 + h^2)^2. Differences of near
/// numbers are multiplied out: from afar a short cylinder is a small step of h.
struct LineIntegrals {
  double square, risen;
};
LineIntegrals between(double a, double low, double high) {
  const double q_low = a * a + low * low, q_high = a * a + high * high, step = high - low;
  const double angle = std::atan2(step * a, a * a + low * high);  // under which the line is seen
  return {(step * (a * a - low * high) / q_low / q_high + angle / a) / (2 * a * a),
          0.5 * step * (high + low) / q_low / q_high};
}

}  // namespace

LambertianCylinder::LambertianCylinder(const Vector3& center_mm, const Vector3& axis, double radius_mm,
                                       double length_mm, double power_w)
    : LambertianSurface(center_mm, axis, power_w), radius_mm_(radius_mm), half_length_mm_(0.5 * length_mm) {
  require_size(radius_mm, "radius");
  require_size(length_mm, "length");
}

double LambertianCylinder::extent_mm() const { return std::hypot(radius_mm_, half_length_mm_); }

double LambertianCylinder::intensity_w_per_sr(const Vector3& direction) const {
  return power_w() / CosineLaw::sine().total_sr() * CosineLaw::sine()(direction.dot(frame().col(2)));
}

std::string LambertianCylinder::words() const {
  return fmt::format("a Lambertian cylinder of radius {:g} mm and length {:g} mm with dark ends", radius_mm_,
                     2 * half_length_mm_);
}

Emitter LambertianCylinder::emitter() const {
  return {center_mm(), extent_mm(), CosineLaw::sine(), frame().col(2), false};
}

LambertianSurface::Place LambertianCylinder::place(double first, double second) const {
  const Vector3 outwards =
      std::cos(2 * pi * second) * frame().col(0) + std::sin(2 * pi * second) * frame().col(1);
  return {center_mm() + (2 * first - 1) * half_length_mm_ * frame().col(2) + radius_mm_ * outwards, outwards};
}

Ray LambertianCylinder::emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const {
  const Vector3 direction = map.direction(numbers[0], numbers[1]);
  const Vector3 axis = frame().col(2), across = direction - direction.dot(axis) * axis;
  const double length = across.norm();
  // Along the axis nothing is seen of the side; a rounding's worth of light may still be asked for there.
  const Vector3 towards = length > 0 ? Vector3(across / length) : Vector3(frame().col(0));
  const double aside = 2 * numbers[3] - 1, forward = std::sqrt((1 - aside) * (1 + aside));
  return {center_mm() + (2 * numbers[2] - 1) * half_length_mm_ * axis +
              radius_mm_ * (forward * towards + aside * axis.cross(towards)),
          direction};
}

double LambertianCylinder::unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const {
  // In the cylinder's frame and in its radii, the element in the half-plane of x.
  const Vector3 local = frame().transpose() * (point_mm - center_mm()) / radius_mm_;
  const double d = std::hypot(local.x(), local.y()), half = half_length_mm_ / radius_mm_;
  if (!(d > 1)) return 0;  // within, or over an end, which is dark
  const Vector3 facing = frame().transpose() * normal;
  const double n_x = (facing.x() * local.x() + facing.y() * local.y()) / d;
  const double n_y = (facing.y() * local.x() - facing.x() * local.y()) / d, n_z = facing.z();

  // Of the line at one azimuth: both cosines are straight in the height h over the element, of which only the
  // side's own has no h.
  const auto line = [&](double azimuth) {
    const double c = std::cos(azimuth), s = std::sin(azimuth);
    const double out = d * c - 1;  // the way to the element, along the line's outward normal
    if (!(out > 0)) return 0.0;
    const double base = (c - d) * n_x + s * n_y, a = std::hypot(c - d, s);
    double low = -half - local.z(), high = half - local.z();  // h
    if (n_z > 0) low = std::max(low, -base / n_z);
    if (n_z < 0) high = std::min(high, -base / n_z);
    if (!(low < high) || (n_z == 0 && !(base > 0))) return 0.0;
    const LineIntegrals of_line = between(a, low, high);
    return out * (base * of_line.square + n_z * of_line.risen);
  };
  // The lines that are seen, parted where the element's plane begins to cut them or lets go of them.
  const double last = std::acos(1 / d);
  std::vector<double> ends{-last, 0, last};
  const auto part_at = [&](double h) {  // base + h n_z = 0: c n_x + s n_y = d n_x - h n_z
    const double swing = std::hypot(n_x, n_y), level = d * n_x - h * n_z;
    if (!(std::abs(level) < swing)) return;
    const double middle = std::atan2(n_y, n_x), aside = std::acos(level / swing);
    for (const double azimuth : {middle - aside, middle + aside}) {
      const double turned = std::remainder(azimuth, 2 * pi);
      if (std::abs(turned) < last) ends.push_back(turned);
    }
  };
  part_at(-half - local.z());
  part_at(half - local.z());
  std::sort(ends.begin(), ends.end());
  constexpr double tolerance = 1e-10;
  constexpr unsigned deepest = 20;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    if (ends[i] < ends[i + 1])
      sum += boost::math::quadrature::gauss_kronrod<double, 15>::integrate(line, ends[i], ends[i + 1],
                                                                           deepest, tolerance);
  const double exitance = power_w() / (2 * pi * radius_mm_) / (2 * half_length_mm_);
  return exitance / pi * std::max(0.0, sum);
}

}  // namespace catoptric::sim
