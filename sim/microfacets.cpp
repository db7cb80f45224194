#include "sim/microfacets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace catoptric::sim {

Vector3 Microfacets::visible_normal(const Vector3& from, double first, double second) const {
  // Stretched so that the microfacets make a hemisphere, of which a disc is seen, its lower part from below.
  const Vector3 seen = Vector3(alpha_ * from.x(), alpha_ * from.y(), from.z()).normalized();
  const double across_square = seen.x() * seen.x() + seen.y() * seen.y();
  const Vector3 along = across_square > 0
                            ? Vector3(Vector3(-seen.y(), seen.x(), 0) / std::sqrt(across_square))
                            : Vector3(Vector3::UnitX());
  const Vector3 up = seen.cross(along);
  const double radius = std::sqrt(first), angle = 2 * pi * second;
  const double a = radius * std::cos(angle), level = radius * std::sin(angle);
  const double share = 0.5 * (1 + seen.z());
  const double b = (1 - share) * std::sqrt(std::max(0.0, 1 - a * a)) + share * level;
  const double c = std::sqrt(std::max(0.0, 1 - a * a - b * b));
  const Vector3 normal = a * along + b * up + c * seen;
  return Vector3(alpha_ * normal.x(), alpha_ * normal.y(), std::max(0.0, normal.z())).normalized();
}

double Microfacets::stretched(const Vector3& direction) const {
  const double sine_square = direction.x() * direction.x() + direction.y() * direction.y();
  return std::sqrt(direction.z() * direction.z() + alpha_ * alpha_ * sine_square);
}

double Microfacets::unshadowed(const Vector3& from, const Vector3& to) const {
  const double a = stretched(from), b = stretched(to);
  return std::min(1.0, (a + from.z()) * to.z() / (a * to.z() + b * from.z()));
}

double Microfacets::facets(const Vector3& normal) const {
  const double square = alpha_ * alpha_;
  const double sine_square = normal.x() * normal.x() + normal.y() * normal.y();
  const double sum = square * normal.z() * normal.z() + sine_square;
  return square / (pi * sum * sum);
}

double Microfacets::density(const Vector3& from, const Vector3& to) const {
  const Vector3 half = (from + to).normalized();
  if (!(half.z() > 0)) return 0;
  return facets(half) / (2 * (from.z() + stretched(from)));
}

double Microfacets::distribution(const Vector3& from, const Vector3& to) const {
  if (!(to.z() > 0) || !(from.z() > 0)) return 0;
  return facets((from + to).normalized()) / (2 * (stretched(from) * to.z() + stretched(to) * from.z()));
}

}  // namespace catoptric::sim
