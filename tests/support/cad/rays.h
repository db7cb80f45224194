#pragma once

#include <cmath>
#include <vector>

#include "base/profile.h"
#include "base/random_stream.h"
#include "base/ray.h"
#include "base/units.h"

/// Random rays in the classes in which intersectors are known to differ, and what judges their hits.
namespace catoptric::test {

/// S: from near a focus to the surface. I: from there in all directions. P: along the axis, a third of them
/// at 0.999 to 0.99999 of the rim. G: from five diagonals away to the surface, many of them grazing.
enum class RayClass { from_focus, isotropic, parallel, grazing };
inline constexpr RayClass all_classes[] = {RayClass::from_focus, RayClass::isotropic, RayClass::parallel,
                                           RayClass::grazing};
inline const char* name(RayClass which) {
  constexpr const char* names[] = {"S", "I", "P", "G"};
  return names[static_cast<int>(which)];
}

inline Vector3 random_direction(RandomStream& random) {
  const double z = 2 * random.uniform() - 1;
  const double phi = 2 * pi * random.uniform();
  const double h = std::sqrt(1 - z * z);
  return {h * std::cos(phi), h * std::sin(phi), z};
}

inline Vector3 surface_point(const Profile& profile, double u, double phi) {
  const MeridianPoint p = profile.at(u);
  return {p.r_mm * std::cos(phi), p.r_mm * std::sin(phi), p.z_mm};
}

inline Vector3 random_surface_point(const Profile& profile, RandomStream& random) {
  const double share = random.uniform();
  const double phi = 2 * pi * random.uniform();
  return surface_point(
      profile, profile.first_parameter() + share * (profile.last_parameter() - profile.first_parameter()),
      phi);
}

inline Ray random_ray(RayClass which, const Profile& profile, const Vector3& focus, std::uint64_t seed,
                      std::uint64_t number) {
  RandomStream random(seed, Purpose::test, number);
  const double size = profile.diagonal_mm();
  switch (which) {
    case RayClass::from_focus: {
      const Vector3 origin = focus + 0.02 * size * random_direction(random);
      return {origin, (random_surface_point(profile, random) - origin).normalized()};
    }
    case RayClass::isotropic: {
      const Vector3 origin = focus + 0.02 * size * random_direction(random);
      return {origin, random_direction(random)};
    }
    case RayClass::parallel: {
      const double share = std::sqrt(random.uniform());
      const double phi = 2 * pi * random.uniform();
      const double choice = random.uniform();
      const double r = profile.r_max_mm() * (choice < 1.0 / 3 ? 1 - std::pow(10.0, -3 - 6 * choice) : share);
      const double side = random.uniform() < 0.5 ? -1 : 1;
      return {{r * std::cos(phi), r * std::sin(phi), focus.z() - 3 * side * size}, {0, 0, side}};
    }
    case RayClass::grazing:
      break;
  }
  const Vector3 origin = focus + 5 * size * random_direction(random);
  return {origin, (random_surface_point(profile, random) - origin).normalized()};
}

/// How far a hit is from its own ray and from the surface at its own parameter: the backward error.
inline double backward_error(const Profile& profile, const Ray& ray, const Hit& hit) {
  const double from_ray = (ray.origin_mm + hit.distance_mm * ray.direction - hit.point_mm).norm();
  const MeridianPoint p = profile.at(hit.parameter);
  const double from_surface =
      std::hypot(std::hypot(hit.point_mm.x(), hit.point_mm.y()) - p.r_mm, hit.point_mm.z() - p.z_mm);
  return std::max(from_ray, from_surface);
}

}  // namespace catoptric::test
