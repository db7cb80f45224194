#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "sim/scene.h"

namespace catoptric::sim {

/// Which breaks of the reflected irradiance an estimate does not know of itself.
enum class UnknownBreaks {
  edges_and_folds,  ///< the photon map blurs across both
  folds,            ///< rings stop at the images of the mirror's edges
};

/// How far from the patch the reflected irradiance is smooth.
struct SmoothReach {
  double clear_mm = HUGE_VAL;          ///< beyond the patch, no break is nearer; 0 for one on the patch
  std::optional<std::string> nearest;  ///< what that break is, in words
};

/// Looks for what may make the irradiance reflected onto the near field jump, peak without bound, or change
/// faster than a grid of rays resolves.
///
/// Rays from the source to a grid of points of the mirror are reflected onto the near field's plane. The
/// field is called smooth where all of them reach the mirror unhindered and meet it once; where the images of
/// the mirror's edges, and of its jumps in direction and curvature, do not lie; and where the cells between
/// the rays land with one orientation and with an irradiance that changes from cell to cell by less than a
/// factor of two: where they turn over or crowd there is a fold or a focus. What is finer than the grid of
/// some 500 rays is not seen.
/// @out   a break on the patch also for what cannot be told: sources other than points, light through the
///        mirror, a real near field that is not rings' own, light that meets the mirror again
/// @in    enough_mm: how far away a break does not matter any more
/// @cost  some 0.06 ms for a source on the axis, else 0.2 ms, with the engine "meridian"
SmoothReach find_breaks(const Scene& scene, UnknownBreaks unknown, double enough_mm = HUGE_VAL);

}  // namespace catoptric::sim
