#pragma once

#include <array>

#include "base/ray.h"

namespace catoptric::sim {

class ProjectionMap;

/// A photon as it leaves the source.
struct Emission {
  Ray ray;
  double
      power_w;  ///< of one photon if it were the only one emitted; the tracer divides by the number emitted
};

/// A light source.
class Source {
 public:
  virtual ~Source() = default;
  virtual double power_w() const = 0;
  virtual Vector3 position_mm() const = 0;

  /// One photon into the directions of `map`, carrying (solid angle of the map / solid angle emitted into) of
  /// the power.
  /// @in    numbers: uniform in [0, 1)
  /// @from  Jensen & Christensen 1995; paper section 4.4
  virtual Emission emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const = 0;

  /// Irradiance straight from the source on a surface element, W/mm^2, with occlusion by the mirror; 0 behind
  /// the element.
  virtual double direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                                  double lift_mm) const = 0;
};

/// A point that radiates the same in all directions.
class PointSource final : public Source {
 public:
  PointSource(const Vector3& position_mm, double power_w) : position_mm_(position_mm), power_w_(power_w) {}
  double power_w() const override { return power_w_; }
  Vector3 position_mm() const override { return position_mm_; }
  Emission emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const override;
  double direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                          double lift_mm) const override;

 private:
  Vector3 position_mm_;
  double power_w_;
};

}  // namespace catoptric::sim
