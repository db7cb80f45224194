#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace catoptric {

class Profile;

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;

/// A half-line. The optical axis is the z axis of the coordinates.
struct Ray {
  Vector3 origin_mm;
  Vector3 direction;  ///< unit length
};

/// Where a ray meets the mirror.
struct Hit {
  double distance_mm;  ///< along the ray, from its origin
  Vector3 point_mm;    ///< on the mirror: revolved from the generatrix, not origin + distance * direction
  Vector3 normal;      ///< unit, perpendicular to the true surface, turned against the ray
  double parameter;    ///< of the generatrix, in the profile's knot range
};

/// Answers rays for one task; never shared between threads, since engines keep caches in it.
class Probe {
 public:
  virtual ~Probe() = default;

  /// The nearest hit farther along the ray than `beyond_mm` (>= 0).
  /// @out   nothing when the ray meets no part of the mirror there
  virtual std::optional<Hit> first_hit(const Ray& ray, double beyond_mm) = 0;

  /// All hits farther than `beyond_mm`, nearest first, each once.
  virtual std::vector<Hit> all_hits(const Ray& ray, double beyond_mm) = 0;

  /// The nearest hits of many rays: hits[i] belongs to rays[i], and no ray's hit depends on the others.
  /// Engines that work on several rays at a time answer here; the rest go one by one.
  /// @in    as many hits as rays
  virtual void first_hits(std::span<const Ray> rays, double beyond_mm, std::span<std::optional<Hit>> hits) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = first_hit(rays[i], beyond_mm);
  }

  /// Whether the mirror stands between two points, hits within `lift_mm` of either end not counted.
  bool blocks(const Vector3& from_mm, const Vector3& to_mm, double lift_mm) {
    const Vector3 way = to_mm - from_mm;
    const double length_mm = way.norm();
    if (length_mm <= 2 * lift_mm) return false;
    const auto hit = first_hit({from_mm, way / length_mm}, lift_mm);
    return hit && hit->distance_mm < length_mm - lift_mm;
  }
};

/// A mirror of revolution about the z axis, as one intersection engine sees it. Safe to share between
/// threads.
class Reflector {
 public:
  virtual ~Reflector() = default;
  virtual std::unique_ptr<Probe> probe() const = 0;
  virtual const Profile& profile() const = 0;
  /// "occt", "meridian", ...
  virtual std::string_view engine() const = 0;
};

}  // namespace catoptric
