#pragma once

#include <optional>

#include "base/profile.h"
#include "base/ray.h"

namespace catoptric::sim {

/// The mouth of a bowl-shaped mirror: a way out on which a photon certainly meets the mirror no more, so that
/// nothing need be intersected.
///
/// Proof. Let the generatrix start on the axis (or on a hole's edge, closed by a lid) and end on the rim, at
/// its lowest (or highest) height, and let its control polygon with its image beyond the axis be convex. A
/// line meets a rational curve of positive weights no more often than its control polygon (variation
/// diminishing), so the curve, its image and the rim's chord bound a convex region, and their revolution a
/// convex body. The stretch from a point of the mirror that is not in the rim's plane to a point strictly
/// inside the mouth lies in that body, and inside the stretch it touches the body's surface nowhere: it would
/// have to lie in a supporting plane through an inner point of the mouth, and the only one is the rim's own.
/// Beyond the rim's plane there is no mirror.
class Opening {
 public:
  /// @out   nothing where the proof does not hold; that the mirror is met again is then possible, not certain
  static std::optional<Opening> of(const Profile& profile);

  /// Whether the ray, which starts on the mirror, leaves through the mouth.
  bool lets_out(const Ray& ray) const {
    const double climb = outward_ * ray.direction.z();
    const double height_mm = outward_ * (rim_z_mm_ - ray.origin_mm.z());
    if (!(climb > 0 && height_mm > least_height_mm_)) return false;
    const double distance_mm = height_mm / climb;
    const double x = ray.origin_mm.x() + distance_mm * ray.direction.x();
    const double y = ray.origin_mm.y() + distance_mm * ray.direction.y();
    return x * x + y * y < safe_square_mm2_;
  }

  /// The same for a ray that stays in a meridian plane; without branches, for loops over several rays.
  [[gnu::always_inline]] bool lets_out(double x_mm, double z_mm, double dx, double dz) const {
    const double climb = outward_ * dz, height_mm = outward_ * (rim_z_mm_ - z_mm);
    const double x = x_mm + height_mm / climb * dx;
    return (climb > 0) & (height_mm > least_height_mm_) & (x * x < safe_square_mm2_);
  }

 private:
  Opening() = default;
  double rim_z_mm_ = 0;
  double outward_ = 0;          ///< -1 for a mouth that looks down, 1 for one that looks up
  double safe_square_mm2_ = 0;  ///< square of the mouth's radius less what rounding may do
  double least_height_mm_ = 0;
};

}  // namespace catoptric::sim
