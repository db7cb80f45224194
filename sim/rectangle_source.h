#pragma once

#include <array>

#include "sim/lambertian_surface.h"

namespace catoptric::sim {

/// A flat rectangle that radiates from the side of its normal by Lambert's law, everywhere alike; the other
/// side is dark. An LED's chip or a field of them.
class LambertianRectangle final : public LambertianSurface {
 public:
  /// @in    along: the direction of the width, made perpendicular to the normal
  /// @fails InputError as PointSource, for a width or height that is not positive and finite, and `along`
  ///        without direction or parallel to the normal
  LambertianRectangle(const Vector3& center_mm, const Vector3& normal, const Vector3& along, double width_mm,
                      double height_mm, double power_w);
  double extent_mm() const override { return half_diagonal_mm_; }
  double tilt_rad() const override { return tilt_of(frame().col(2)); }
  bool is_round() const override { return false; }
  double intensity_w_per_sr(const Vector3& direction) const override;
  std::string words() const override;
  std::string left_out() const override { return "the rectangle itself stands in no light's way"; }

  /// Directions about the normal, the same for all points of the rectangle.
  Emitter emitter() const override;
  /// @in    numbers: two for the direction, two for the place
  Ray emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const override;

  /// In closed form: the part of the rectangle before the element's plane is a polygon.
  /// @from  Lambert 1760 for polygons; Baum, Rushmeier & Winget 1989
  double unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const override;

 private:
  Place place(double first, double second) const override;

  Vector3 half_width_, half_height_;  ///< mm
  double area_mm2_, half_diagonal_mm_;
  double width_mm_, height_mm_;
};

}  // namespace catoptric::sim
