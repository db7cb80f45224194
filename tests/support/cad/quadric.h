#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/profile.h"
#include "base/ray.h"

namespace catoptric::test {

using Wide = long double;

/// A profile whose surface has a closed form: r^2 = c0 + c1 z + c2 z^2 for z_low <= z <= z_high.
struct Quadric {
  const char* name;
  Profile profile;
  Wide c0, c1, c2, z_low, z_high;
  Vector3 focus;
  /// The focal length is 5 mm, the rim at r = 10 mm.
  static Quadric paraboloid() {
    return {"paraboloid",    Profile::bezier({{0, 10, 1}, {5, 10, 1}, {10, 5, 1}}), 200, -20, 0, 5, 10,
            Vector3(0, 0, 5)};
  }
  static Quadric half_sphere() {
    return {
        "half sphere",   Profile::bezier({{0, 10, 1}, {5, 10, std::sqrt(0.5)}, {5, 5, 1}}), 0, 10, -1, 5, 10,
        Vector3(0, 0, 5)};
  }
  /// Half of an ellipsoid with semi-axes 6 across and 10 along the axis; foci at z = -8 and 8.
  static Quadric half_ellipsoid() {
    return {"half ellipsoid",
            Profile::bezier({{0, 10, 1}, {6, 10, std::sqrt(0.5)}, {6, 0, 1}}),
            36,
            0,
            -Wide(36) / 100,
            0,
            10,
            Vector3(0, 0, 8)};
  }
  /// Tip at z = 8 on the axis, slope 2.
  static Quadric cone() {
    return {"cone", Profile::bezier({{0, 8, 1}, {4, 0, 1}}), 16, -4, 0.25L, 0, 8, Vector3(0, 0, 4)};
  }
  static Quadric cylinder() {
    return {"cylinder", Profile::bezier({{3, 12, 1}, {3, 2, 1}}), 9, 0, 0, 2, 12, Vector3(0, 0, 7)};
  }
  static std::vector<Quadric> all() {
    return {paraboloid(), half_sphere(), half_ellipsoid(), cone(), cylinder()};
  }
};

/// Hits of the closed form in 64-bit arithmetic.
struct TrueHits {
  std::vector<Wide> distances;
  bool doubtful = false;  ///< tangent, or at the rim, within the rounding of double
};

/// @in rounding  relative error of the profile against its closed form: 16 roundings of double where poles or
///               weights are not exact; 64 of long double's where they are
inline TrueHits true_hits(const Quadric& q, const Ray& ray, Wide rounding = 16 * 0x1p-53L) {
  const Wide ox = ray.origin_mm.x(), oy = ray.origin_mm.y(), z0 = ray.origin_mm.z();
  const Wide dx = ray.direction.x(), dy = ray.direction.y(), dz = ray.direction.z();
  // From the closest approach to the part, so that a far source costs no digits.
  const Wide oz0 = z0 - q.focus.z();
  const Wide shift = -(ox * dx + oy * dy + oz0 * dz);
  const Wide x = ox + shift * dx, y = oy + shift * dy, z = z0 + shift * dz;
  const Wide a = dx * dx + dy * dy - q.c2 * dz * dz;
  const Wide b = 2 * (x * dx + y * dy) - (q.c1 + 2 * q.c2 * z) * dz;
  const Wide c = x * x + y * y - (q.c0 + z * (q.c1 + q.c2 * z));
  const Wide size = q.profile.diagonal_mm();
  TrueHits hits;
  if (a == 0 && b == 0) return hits;  // along the side of a cylinder
  const Wide discriminant = b * b - 4 * a * c;
  hits.doubtful = std::abs(discriminant) <= rounding * (b * b + 4 * std::abs(a) * size * size);
  if (discriminant < 0) return hits;
  const Wide both = -(b + (b < 0 ? -1 : 1) * std::sqrt(discriminant)) / 2;
  std::vector<Wide> roots;
  if (a != 0) roots.push_back(both / a);
  if (both != 0) roots.push_back(c / both);
  for (const Wide t : roots) {
    const Wide at = z + t * dz;
    if (!(std::abs(t) < 10 * size)) continue;  // the part is nearer
    // Both ends may lie where the quadric is level, so that the height of a hit near them is only known to
    // the square root of a rounding; the radius decides there.
    const Wide r_squared = std::max(Wide(0), q.c0 + at * (q.c1 + q.c2 * at));
    const bool vertex = r_squared <= size * size * 1e-14L;
    if (!vertex && (std::abs(at - q.z_low) <= rounding * size || std::abs(at - q.z_high) <= rounding * size))
      hits.doubtful = true;
    if (at >= q.z_low - (vertex ? rounding * size : 0) && at <= q.z_high + (vertex ? rounding * size : 0) &&
        shift + t > 0)
      hits.distances.push_back(shift + t);
  }
  std::sort(hits.distances.begin(), hits.distances.end());
  return hits;
}

}  // namespace catoptric::test
