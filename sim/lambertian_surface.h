#pragma once

#include <Eigen/Core>

#include "sim/source.h"

namespace catoptric::sim {

/// A surface that radiates by Lambert's law, everywhere alike. It stands in no light's way: a mirror's light
/// passes through it as if it were not there.
class LambertianSurface : public MappedSource {
 public:
  double power_w() const override { return power_w_; }
  Vector3 position_mm() const override { return center_mm_; }

  /// The unhindered irradiance times the share of it that a fixed set of places of the surface can send past
  /// the mirror.
  /// @error where the mirror hides part of the surface, about a hundredth of the unhindered irradiance
  /// @cost  one question to the probe a place, as far as the element sees it
  double direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                          double lift_mm) const override;

 protected:
  struct Place {
    Vector3 point_mm, normal;
  };

  /// @fails InputError as check_source
  LambertianSurface(const Vector3& center_mm, const Vector3& axis, double power_w);

  /// Refuses a size that is not positive and finite.
  /// @fails InputError naming it
  static void require_size(double size_mm, const char* what);

  /// A place on the surface, by area: two numbers in [0, 1), the second of them round where the surface is.
  virtual Place place(double first, double second) const = 0;

  /// How many of them say what is hidden.
  virtual int probed_places() const { return 256; }

  const Vector3& center_mm() const { return center_mm_; }
  const Eigen::Matrix3d& frame() const { return frame_; }

 private:
  Vector3 center_mm_;
  double power_w_;
  Eigen::Matrix3d frame_;  ///< columns: two directions across the axis, the axis
};

}  // namespace catoptric::sim
