#pragma once

#include <vector>

#include "sim/scene.h"

namespace catoptric::sim {

/// Where on the near field's plane the light of a point source on the axis may end or jump sharply: the
/// squares of the radii at which the rays land that meet the mirror on an edge of its generatrix, or where
/// its direction or curvature jumps, after any number of reflections. Edges of shadows and folds are not
/// among them.
/// @in   a scene to which rings_objection() has none
/// @out  in no order, repetitions possible
std::vector<double> edge_landing_squares(const Scene& scene);

}  // namespace catoptric::sim
