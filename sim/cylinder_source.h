#pragma once

#include "sim/lambertian_surface.h"

namespace catoptric::sim {

/// A straight cylinder whose side radiates by Lambert's law, everywhere alike, and whose ends are dark: a
/// coiled filament, a tube. From afar its intensity goes like the sine of the angle to its axis.
class LambertianCylinder final : public LambertianSurface {
 public:
  /// @fails InputError as PointSource, and for a radius or length that is not positive and finite
  LambertianCylinder(const Vector3& center_mm, const Vector3& axis, double radius_mm, double length_mm,
                     double power_w);
  double extent_mm() const override;
  double tilt_rad() const override { return tilt_of(frame().col(2)); }
  double intensity_w_per_sr(const Vector3& direction) const override;
  std::string words() const override;
  std::string left_out() const override { return "the cylinder itself stands in no light's way"; }

  Emitter emitter() const override;

  /// All of the side's light in one direction comes evenly from the rectangle that it is seen as.
  /// @in    numbers: two for the direction, two for the place
  Ray emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const override;

  /// An integral round the cylinder of the part of it that the element sees, along the cylinder in closed
  /// form; asked for to 1e-10. 0 within the cylinder.
  double unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const override;

 private:
  Place place(double first, double second) const override;
  int probed_places() const override { return 512; }  // half of them look away

  double radius_mm_, half_length_mm_;
};

}  // namespace catoptric::sim
