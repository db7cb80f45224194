#pragma once

#include <memory>
#include <span>
#include <vector>

#include "design/scene.h"
#include "sim/near_field.h"

namespace catoptric::design {

struct FarField;

/// Where irradiance is compared, and what is wanted there.
struct Target {
  std::vector<sim::FieldSample> samples;
  std::vector<double> irradiance_w_per_mm2;  ///< empty when the scene wants nothing
  std::vector<double> weights = {};          ///< how much a sample counts; empty: all alike
  std::vector<double> areas_mm2 = {};        ///< that each sample stands for; empty: all alike
  std::vector<char> within_reach = {};       ///< 1 at samples within the target's outer edge
  std::vector<char> lit = {};                ///< 1 where light is wanted, by the target without a kernel
  std::shared_ptr<const FarField> far = {};  ///< what is wanted from afar; null: nothing
  bool intensities = false;                  ///< directions and W/sr, of a FarField
  bool through_kernel = false;  ///< seen through the scene's kernel, whose blur cancels in the comparison
};

/// Reflected irradiance of a paraboloid with the source in its focus, at a distance from the axis.
/// @from paper eq. 12; zero beyond the rim, which the paper's formula does not know
double paraboloid_reflected_w_per_mm2(double power_w, double focal_length_mm, double rim_radius_mm,
                                      double distance_mm);

/// Irradiance straight from a point source on a plane across the axis.
/// @from paper eq. 13
double paraboloid_direct_w_per_mm2(double power_w, double height_mm, double distance_mm);

/// The scene's samples with their desired irradiance.
/// @fails InputError when a table cannot be read, or a point of it does not lie on the near field
/// @error a reference reflector's light is seen through the scene's kernel, so that the kernel's bias cancels
/// in
///        the comparison: by tubes where the model takes them, else with 16 times the scene's photons, a
///        quarter of the noise of one evaluation; a target along the radius is smoothed by the kernel where
///        it has a fixed radius. Paraboloids, tables of points
///        and pictures are taken as they are
Target make_target(const Scene& scene);

/// The same with paraboloids too seen through the kernel, so that a wide kernel's blur is on both sides of
/// the comparison.
/// @in    the scene has a kernel radius
Target blurred_target(const Scene& scene);

/// The same for fields without a kernel, which is what an accuracy is proven for: a reference reflector's
/// light is found to a quarter of the scene's accuracy. A sample next to a jump counts in full for the side
/// it lies on.
/// @in    the scene asks for an accuracy
Target make_sharp_target(const Scene& scene);

}  // namespace catoptric::design
