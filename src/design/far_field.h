#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "design/scene.h"
#include "design/target.h"

namespace catoptric::design {

/// The luminaire seen from afar, as a goniophotometer sees it: mirror and source alone, without the near
/// field. A plane so far away that a place on it is a direction stands in for the near field, so that every
/// rung computes intensities as it computes irradiance.
struct FarField {
  Scene scene;    ///< with that plane, and a kernel of the resolution asked for
  Target target;  ///< directions even in solid angle within the table's angles; intensities wanted, W/sr
  std::vector<double> area_per_sr_mm2;  ///< of each direction: what makes irradiance intensity

  /// Irradiance at the samples, W/mm^2, as intensity, W/sr.
  std::vector<double> as_intensity(std::vector<double> irradiance_w_per_mm2) const;
};

/// What `target.intensity_file` asks for; nothing where it is not given.
/// @error a mirror's size over the distance, 1e-5 rad. The kernel is one of the plane: at an angle t to the
///        axis the resolution is cos^2 t times the one asked for, along the angle. As in the near field, the
///        mirror's part of what is wanted is seen through the same kernel, whose blur so cancels
std::shared_ptr<const FarField> far_field(const Scene& scene);

/// Intensity of one mirror in the directions of `far`, W/sr.
std::vector<double> intensity_by_rung(const FarField& far, sim::Rung rung, const Candidate& candidate,
                                      std::uint64_t stream);

}  // namespace catoptric::design
