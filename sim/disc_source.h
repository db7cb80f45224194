#pragma once

#include "sim/lambertian_surface.h"

namespace catoptric::sim {

/// A flat disc that radiates from the side of its normal by Lambert's law, everywhere alike; the other side
/// is dark.
class LambertianDisc final : public LambertianSurface {
 public:
  /// @fails InputError as PointSource, and for a radius that is not positive and finite
  LambertianDisc(const Vector3& center_mm, double radius_mm, const Vector3& normal, double power_w);
  double extent_mm() const override { return radius_mm_; }
  double tilt_rad() const override { return tilt_of(frame().col(2)); }
  double intensity_w_per_sr(const Vector3& direction) const override;
  std::string words() const override;
  std::string left_out() const override { return "the disc itself stands in no light's way"; }

  /// Directions about the normal, the same for all points of the disc: what any of them may see of the
  /// mirror. Photons whose own point sees nothing there are counted as missed.
  Emitter emitter() const override;
  /// @in    numbers: two for the direction, two for the place
  Ray emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const override;

  /// In closed form where the element's plane leaves all of the disc on one side; else an integral along the
  /// rim, to 1e-10.
  /// @from  configuration factors of a disc: Hamilton & Morgan 1952; rim: Lambert's formula for any contour
  double unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const override;

 private:
  double exitance() const;
  double of_whole(const Vector3& local, const Vector3& normal) const;
  double of_part(const Vector3& local, const Vector3& normal) const;
  Place place(double first, double second) const override;

  double radius_mm_;
};

}  // namespace catoptric::sim
