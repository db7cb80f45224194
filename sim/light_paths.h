#pragma once

#include <optional>
#include <vector>

#include "base/ray.h"
#include "sim/tracer.h"

namespace catoptric::sim {

/// The way of one photon: where it starts and every place at which it turns or ends.
struct LightPath {
  std::vector<Vector3> corners_mm;
  std::optional<Vector3> leaves_towards;  ///< unit; nothing where it was absorbed at its last corner
  std::optional<Vector3> landed_mm;       ///< where it last met the near field's own patch
  bool met_mirror = false;
};

/// The ways of the first photons of a set, traced like those that a verdict counts and with the same numbers.
/// For pictures: nothing is estimated from them.
/// @in    options.photons as many as there are ways; some hundreds make sense
/// @out   in the order of the photons, the same bits whatever the threads
/// @fails as PhotonFlights
std::vector<LightPath> light_paths(const Scene& scene, const PhotonOptions& options);

}  // namespace catoptric::sim
