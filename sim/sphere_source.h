#pragma once

#include "sim/lambertian_surface.h"

namespace catoptric::sim {

/// A sphere whose surface radiates by Lambert's law, everywhere alike: an opal globe, or an arc taken for
/// one. From afar it is a point that shines the same in all directions.
class LambertianSphere final : public LambertianSurface {
 public:
  /// @fails InputError as PointSource, and for a radius that is not positive and finite
  LambertianSphere(const Vector3& center_mm, double radius_mm, double power_w);
  double extent_mm() const override { return radius_mm_; }
  double intensity_w_per_sr(const Vector3& direction) const override;
  std::string words() const override;
  std::string left_out() const override { return "the sphere itself stands in no light's way"; }

  Emitter emitter() const override;

  /// All of a sphere's light in one direction comes evenly from the disc that it is seen as.
  /// @in    numbers: two for the direction, two for the place
  Ray emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const override;

  /// In closed form, cut by the element's plane or not; 0 within the sphere.
  /// @from  Snyder 1996, Area Light Sources for Real-Time Graphics, as given by Lagarde & de Rousiers 2014
  double unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const override;

 private:
  Place place(double first, double second) const override;
  int probed_places() const override { return 512; }  // half of them look away

  double radius_mm_;
};

}  // namespace catoptric::sim
