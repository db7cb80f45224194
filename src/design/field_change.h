#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "design/deviations.h"
#include "design/sensitivity.h"

namespace catoptric::design {

/// Changes of the field by a deviation, each replicate by itself.
struct Changes {
  std::vector<std::vector<double>> w_per_mm2;  ///< replicate, point
};

/// The scene's light with and without deviations, at its samples and along a cut, by common random numbers.
class FieldChanger {
 public:
  FieldChanger(const Scene& scene, const Profile& profile);

  /// Field of the deviated scene less the scene's own; nothing where there is no such scene.
  std::optional<Changes> changes(const Deviation& deviation, double amount, sim::Rung rung);

  /// Root mean square over the samples, noise taken off.
  FieldChange measure(const Changes& changes) const;

  /// Means over the replicates along the cut, and their standard errors.
  std::vector<double> along_cut(const Changes& changes) const;
  std::vector<double> noise_along_cut(const Changes& changes) const;

  std::uint64_t replicates(sim::Rung rung) const;
  const std::vector<double>& radii_mm() const { return radii_mm_; }
  std::vector<double> field_along_cut(sim::Rung rung);
  double field_rms_w_per_mm2() const { return rms_; }
  /// That one scene's light takes, all replicates.
  std::uint64_t photons_of_a_scene(sim::Rung rung) const;
  /// Spent on deviated scenes so far.
  std::uint64_t photons() const { return photons_; }

 private:
  Changes fields(const Scene& scene, const Profile& profile, sim::Rung rung);
  const Changes& own(sim::Rung rung);

  const Scene& scene_;
  const Profile& profile_;
  std::vector<sim::FieldSample> points_;  ///< the samples, then the cut
  std::size_t samples_ = 0;
  std::vector<double> radii_mm_;
  std::map<sim::Rung, Changes> own_;
  double rms_ = 0;
  std::uint64_t photons_ = 0;
};

}  // namespace catoptric::design
