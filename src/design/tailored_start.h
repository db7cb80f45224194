#pragma once

#include <optional>
#include <string>
#include <vector>

#include "design/scene.h"
#include "design/tailored_curve.h"

namespace catoptric::design {

/// A mirror found by flux balance and ray directions alone: no photon flew and no irradiance was computed.
struct TailoredStart {
  Profile profile;
  RayMap map;
  double miss_rad;             ///< root mean square of what the rays' directions are off
  double rim_angle_rad;        ///< at the source, from the apex: where all wanted light is placed
  double level;                ///< factor on the target's irradiance; 1 unless the target's scale is free
  double unreachable_rel = 0;  ///< relative root mean square error that direct light alone leaves
  /// Of a mirror from nothing for a point source: how far its light is off, relative root mean square away
  /// from jumps, by ray tubes. Rays may go where they should and the mirror still hide some of them.
  std::optional<double> light_error_rel;
  long evaluations;
  int starts;
  double seconds;
  std::vector<std::string> notes;  ///< what a user should know, in sentences
};

/// Tailors the scene's listed variables, or with `search.free` "profile" all of the generatrix, from the
/// scene's profile with their starts.
/// @fails InputError where the target cannot be reached (see tailored_from_nothing)
TailoredStart tailored_variables(const Scene& scene);

/// Makes a mirror of the scene's tailored.points control points from source, target and package alone; the
/// scene's profile does not count.
///
/// For each ray map the mirror's differential equation is integrated from an apex as far from the source as
/// `tailored.vertex` says, or as the package allows; a B-spline is fitted to that curve and then tailored in
/// all its free variables with the vertex held. Of both maps the one is taken whose light, by ray tubes where
/// they are valid, is nearer to the target.
/// @fails InputError, before anything is searched, where the scene has no symmetry, the target is no function
///        of the radius, too much direct light falls on it, the source's power does not suffice, it lies
///        where a mirror cannot send light, or no mirror fits the package
TailoredStart tailored_from_nothing(const Scene& scene);

}  // namespace catoptric::design
