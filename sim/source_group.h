#pragma once

#include <memory>
#include <vector>

#include "sim/source.h"

namespace catoptric::sim {

/// Several sources that shine together.
class SourceGroup final : public Source {
 public:
  /// @fails InputError for a group of none
  explicit SourceGroup(std::vector<std::unique_ptr<const Source>> parts);
  double power_w() const override;
  /// The middle of the box about all of them.
  Vector3 position_mm() const override { return middle_mm_; }
  double extent_mm() const override { return extent_mm_; }
  /// Whether each of them is upon the z axis and round about it.
  bool is_round() const override;
  /// When one is: then photons bring the direct light of all.
  bool is_sampled() const override { return is_sampled_; }
  double intensity_w_per_sr(const Vector3& direction) const override;
  std::string words() const override;
  std::string left_out() const override;
  std::unique_ptr<Emission> emission_to(const Profile& mirror) const override;
  std::unique_ptr<Emission> emission() const override;
  double unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const override;
  double direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                          double lift_mm) const override;

 private:
  std::vector<std::unique_ptr<const Source>> parts_;
  Vector3 middle_mm_;
  double extent_mm_ = 0;
  bool is_sampled_ = false;
};

}  // namespace catoptric::sim
