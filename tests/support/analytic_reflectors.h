#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/profile.h"
#include "base/ray.h"

namespace catoptric::test {

/// A quadric of revolution r^2 = a + b z + c z^2 between two heights: paraboloid, sphere, ellipsoid, cone
/// (apex outside the heights or at one of them) and cylinder, intersected in closed form. An independent
/// oracle for the engines, and a mirror for tests of light that shall not lean on an engine.
class QuadricReflector final : public Reflector {
 public:
  QuadricReflector(double a, double b, double c, double z_low, double z_high, Profile profile)
      : a_(a), b_(b), c_(c), z_low_(z_low), z_high_(z_high), profile_(std::move(profile)) {}

  std::unique_ptr<Probe> probe() const override { return std::make_unique<QuadricProbe>(*this); }
  const Profile& profile() const override { return profile_; }
  std::string_view engine() const override { return "quadric"; }

 private:
  class QuadricProbe final : public Probe {
   public:
    explicit QuadricProbe(const QuadricReflector& owner) : owner_(owner) {}
    std::optional<Hit> first_hit(const Ray& ray, double beyond_mm) override {
      const auto found = owner_.distances(ray, beyond_mm);
      if (found.count == 0) return std::nullopt;
      return owner_.hit_at(ray, found.distance[0]);
    }
    std::vector<Hit> all_hits(const Ray& ray, double beyond_mm) override {
      const auto found = owner_.distances(ray, beyond_mm);
      std::vector<Hit> hits;
      for (std::size_t i = 0; i < found.count; ++i) hits.push_back(owner_.hit_at(ray, found.distance[i]));
      return hits;
    }

   private:
    const QuadricReflector& owner_;
  };

  struct Distances {
    std::array<double, 2> distance{};
    std::size_t count = 0;
  };

  /// Roots of x^2 + y^2 - a - b z - c z^2 along the ray, by the form of the quadratic formula that does not
  /// cancel.
  Distances distances(const Ray& ray, double beyond) const {
    const Vector3 &o = ray.origin_mm, &d = ray.direction;
    const double second = d.x() * d.x() + d.y() * d.y() - c_ * d.z() * d.z();
    const double half_first = o.x() * d.x() + o.y() * d.y() - (0.5 * b_ + c_ * o.z()) * d.z();
    const double constant = o.x() * o.x() + o.y() * o.y() - a_ - b_ * o.z() - c_ * o.z() * o.z();
    const double discriminant = half_first * half_first - second * constant;
    Distances found;
    if (discriminant < 0) return found;
    const double sum = -(half_first + std::copysign(std::sqrt(discriminant), half_first));
    for (const auto& [above, below] : {std::array{sum, second}, std::array{constant, sum}}) {
      if (below == 0) continue;
      const double t = above / below;
      const double z = o.z() + t * d.z();
      if (std::isfinite(t) && t > beyond && z >= z_low_ && z <= z_high_) found.distance[found.count++] = t;
    }
    if (found.count == 2 && found.distance[1] < found.distance[0])
      std::swap(found.distance[0], found.distance[1]);
    return found;
  }

  Hit hit_at(const Ray& ray, double distance) const {
    const Vector3 point = ray.origin_mm + distance * ray.direction;
    Vector3 normal(point.x(), point.y(), -0.5 * b_ - c_ * point.z());
    normal.normalize();
    if (normal.dot(ray.direction) > 0) normal = -normal;
    return {distance, point, normal, 0.0};
  }

  double a_, b_, c_, z_low_, z_high_;
  Profile profile_;
};

/// The paper's paraboloid, eq. 11 with a = h: focus (0, a), vertex (0, 2 a), rim (2 a, a).
inline QuadricReflector paraboloid(double a_mm = 50) {
  return {8 * a_mm * a_mm,
          -4 * a_mm,
          0,
          a_mm,
          2 * a_mm,
          Profile::bezier({{0, 2 * a_mm, 1}, {a_mm, 2 * a_mm, 1}, {2 * a_mm, a_mm, 1}})};
}

/// Upper half of the ellipsoid of revolution with half axes `radius` across and `height` along z, about
/// (0, center_z). Equal half axes: the hemisphere of the paper's start C.
inline QuadricReflector half_ellipsoid(double center_z_mm, double radius_mm, double height_mm) {
  const double ratio = radius_mm * radius_mm / (height_mm * height_mm);
  const double top = center_z_mm + height_mm;
  return {radius_mm * radius_mm - ratio * center_z_mm * center_z_mm,
          2 * ratio * center_z_mm,
          -ratio,
          center_z_mm,
          top,
          Profile::bezier({{0, top, 1}, {radius_mm, top, std::sqrt(0.5)}, {radius_mm, center_z_mm, 1}})};
}

/// A sphere about (0, center_z), closed at the top and cut off at z_low below; z_low = center - radius is the
/// closed sphere. (The profile is the whole sphere's; a projection map from it is then wider than needed.)
inline QuadricReflector sphere(double center_z_mm, double radius_mm, double z_low_mm) {
  const double top = center_z_mm + radius_mm, bottom = center_z_mm - radius_mm, w = std::sqrt(0.5);
  return {radius_mm * radius_mm - center_z_mm * center_z_mm,
          2 * center_z_mm,
          -1,
          z_low_mm,
          top,
          Profile(2, {0, 0, 0, 0.5, 0.5, 1, 1, 1},
                  {{0, top, 1},
                   {radius_mm, top, w},
                   {radius_mm, center_z_mm, 1},
                   {radius_mm, bottom, w},
                   {0, bottom, 1}})};
}

/// The conical band between two rings; equal radii make a cylinder.
inline QuadricReflector cone(double r_low_mm, double z_low_mm, double r_high_mm, double z_high_mm) {
  const double slope = (r_high_mm - r_low_mm) / (z_high_mm - z_low_mm);
  const double at_zero = r_low_mm - slope * z_low_mm;
  return {at_zero * at_zero, 2 * at_zero * slope,
          slope * slope,     z_low_mm,
          z_high_mm,         Profile::bezier({{r_high_mm, z_high_mm, 1}, {r_low_mm, z_low_mm, 1}})};
}

}  // namespace catoptric::test
