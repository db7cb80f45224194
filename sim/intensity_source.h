#pragma once

#include <Eigen/Core>
#include <memory>

#include "base/intensity_table.h"
#include "sim/source.h"

namespace catoptric::sim {

/// A point with the intensity of a table, as luminaires and LEDs are measured. The table gives the shape; the
/// power is its own number.
class IntensitySource final : public Source {
 public:
  /// @in    axis: the direction of gamma = 0; along: that of C = 0, made perpendicular to the axis
  /// @fails InputError as PointSource, for a table without light, and for `along` parallel to the axis where
  /// the
  ///        table is not rotational
  IntensitySource(const Vector3& position_mm, double power_w, std::shared_ptr<const IntensityTable> table,
                  const Vector3& axis, const Vector3& along = Vector3::UnitX());
  double power_w() const override { return power_w_; }
  Vector3 position_mm() const override { return position_mm_; }
  double tilt_rad() const override { return tilt_of(frame_.col(2)); }
  bool is_round() const override { return table_->is_rotational(); }
  double intensity_w_per_sr(const Vector3& direction) const override;
  std::string words() const override;
  std::string left_out() const override { return "the source is measured from afar: its size is not known"; }
  std::unique_ptr<Emission> emission_to(const Profile& mirror) const override;
  std::unique_ptr<Emission> emission() const override;
  double unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const override {
    return point_irradiance_w_per_mm2(*this, point_mm, normal);
  }
  double direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                          double lift_mm) const override {
    return point_direct_w_per_mm2(*this, point_mm, normal, mirror, lift_mm);
  }

 private:
  Vector3 position_mm_;
  double power_w_, w_per_unit_;  ///< W of the source for one of the table's flux
  std::shared_ptr<const IntensityTable> table_;
  Eigen::Matrix3d frame_;  ///< columns: C = 0, C = 90, gamma = 0
};

}  // namespace catoptric::sim
