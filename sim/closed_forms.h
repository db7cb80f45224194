#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/scene.h"

namespace catoptric::sim {

/// Reflected light that a formula gives.
struct ClosedForm {
  std::string name;               ///< what the mirror was recognised as
  std::vector<double> reflected;  ///< W/mm^2 at the samples
};

/// The reflected irradiance where the scene is one of those with a formula, or nothing: an invisible near
/// field, a mirror that lets nothing through, and
/// - a paraboloid with a point source in its focus: the beam is parallel to the axis and carries
///   reflectance * intensity / (a^2 (1 + r^2 / 4 a^2)^2) within its rim, and past a hole at its vertex, with
///   the intensity towards the mirror there;
/// - a sphere about a point source, less than half of it: every ray goes back through the source, so the
/// field is
///   that of the source in the opposite directions.
/// The generatrix is recognised to within rounding; another mirror, a second meeting or a shadow on the way
/// means no formula.
/// @error 1e-12 of the value
/// @from  paper eq. 12; the sphere: start C of the paper
std::optional<ClosedForm> closed_form(const Scene& scene, std::span<const FieldSample> samples);

}  // namespace catoptric::sim
