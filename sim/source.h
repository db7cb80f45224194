#pragma once

#include <array>

#include "base/ray.h"

namespace catoptric::sim {

class ProjectionMap;

/// A light source. All photons of one source carry the same power, so that a photon map needs no power per
/// photon: a source that is brighter in some directions sends more photons there.
class Source {
 public:
  virtual ~Source() = default;
  virtual double power_w() const = 0;
  virtual Vector3 position_mm() const = 0;

  /// The part of the power that goes into the directions of `map`: for a source that is the same in all
  /// directions, (solid angle of the map / 4 pi) times its power. Photons share it equally.
  /// @from  Jensen & Christensen 1995; paper section 4.4
  virtual double power_into_w(const ProjectionMap& map) const = 0;

  /// How many numbers `emit` uses: the first so many of four.
  virtual std::size_t emission_numbers() const { return 4; }

  /// One photon's path from the source into the directions of `map`.
  /// @in    numbers: uniform in [0, 1)
  /// @out   a continuous function of the numbers as far as the map allows, so that low-discrepancy points
  ///        keep their quality
  virtual Ray emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const = 0;

  /// Irradiance straight from the source on a surface element, W/mm^2, with occlusion by the mirror; 0 behind
  /// the element and in its own plane.
  virtual double direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                                  double lift_mm) const = 0;
};

/// A point that radiates the same in all directions.
class PointSource final : public Source {
 public:
  /// @fails InputError for a position that is not finite, a power that is negative or not finite
  PointSource(const Vector3& position_mm, double power_w);
  double power_w() const override { return power_w_; }
  Vector3 position_mm() const override { return position_mm_; }
  double power_into_w(const ProjectionMap& map) const override;
  std::size_t emission_numbers() const override { return 2; }
  Ray emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const override;
  /// @from  paper eq. 13, for any distance and tilt: power cos / (4 pi distance^2)
  double direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                          double lift_mm) const override;

 private:
  Vector3 position_mm_;
  double power_w_;
};

}  // namespace catoptric::sim
