#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/profile.h"
#include "sim/near_field.h"
#include "sim/scene.h"
#include "sim/source.h"
#include "sim/tube_trace.h"

namespace catoptric::sim {

struct TubesOptions {
  double kernel_radius_mm = 0;         ///< of the Silverman kernel; 0: the pointwise field
  double tolerance_w_per_mm2 = 1e-12;  ///< of the smoothed field: 1e-6 W/m^2
  int most_rays = 100'000;
  long most_meetings = std::numeric_limits<long>::max();  ///< of all rays with the mirror
  int most_interactions = 1000;
  double pointwise_tolerance_w_per_mm2 = 0;  ///< of the pointwise field; 0 has every branch polished by rays
};

/// The reflected (and transmitted) light by deterministic ray tubes.
struct TubesField {
  std::vector<double> irradiance;  ///< W/mm^2, in the order asked for; pointwise infinite on a caustic
  double error_w_per_mm2 = 0;      ///< bound of the error at any of them; above the tolerance when the rays
                                   ///< did not suffice
  int rays = 0;                    ///< from the source, each through all its bounces
  double landed_w = 0;             ///< power of all landings anywhere on the plane, each meeting counted
  double cut_off_w = 0;            ///< power on paths stopped after most_interactions
};

/// Rung "tubes": a point source on the axis, its own axis along it, a specular mirror of revolution, light
/// registered on a plane across the axis. No random numbers.
///
/// Rays of one meridian carry the derivative of their landing radius rho by the emission angle theta through
/// every bounce. Pointwise the irradiance is the sum over all branches of
/// intensity(theta) * sin(theta) / (rho |d rho / d theta|), from the tubes where they are within the
/// tolerance, else polished by rays of its own. Smoothed, it is what the photon rung expects with the same
/// fixed kernel radius: the power of each tube, spread over its rings, under the Silverman kernel; folds and
/// the axis, where the pointwise field is infinite, are as exact as the rest. Many radii are interpolated
/// from few.
/// @in    source on the axis (tubes_objection); radii not negative
/// @fails InputError for a source off the axis or tilted against it, a bad material, a negative kernel
/// radius, most_rays below 100
/// @error error_w_per_mm2: by rays that the tubes do not use, by the rings' rule, by the interpolation's
///        coefficients; polished pointwise 1e-12 of the value or the change by the last polishing
/// @cost  about 0.4 us a ray and bounce; 28 rays for 1e-6 W/m^2 on the paraboloid, 70 to 160 on the paper's
///        starts with their folds; then 20 to 150 smoothed radii of 0.5 to 2 us each, however many are asked
///        for. A cavity whose light bounces many times may need more rays than allowed: the error then says
///        so
/// @from  paper eq. 12 for the paraboloid; flux tubes: Burkhard & Shealy 1981
TubesField tubes_field(const PointSource& source, const Profile& profile, const Material& mirror,
                       const FieldPlane& plane, std::span<const double> radii_mm,
                       const TubesOptions& options);

/// The same at the samples of a near field.
/// @in    no tubes_objection
TubesField tubes_field(const Scene& scene, std::span<const FieldSample> samples, const TubesOptions& options);

/// Why this rung cannot light the scene, in words, or nothing.
std::optional<std::string> tubes_objection(const Source& source, const Profile& profile,
                                           const Material& mirror, const NearField& near_field);

}  // namespace catoptric::sim
