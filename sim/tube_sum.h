#pragma once

#include <span>
#include <vector>

#include "sim/tube_map.h"

namespace catoptric::sim {

struct PointwiseSum {
  double error_w_per_mm2 = 0;
  int rays = 0;
};

/// Adds the pointwise irradiance of all branches, by the tubes where they are within a share of `tolerance`
/// (W/mm^2), else by their halves, and next to a fold polished by Newton's method with rays of its own.
/// @in    radii ascending; values as many
/// @error error_w_per_mm2, the worst radius's sum over branches
/// @cost  by tubes: some 20 ns a radius and branch; halves take five rays, a polished radius two or three
PointwiseSum add_pointwise(const TubeMap& map, const TubeTracer& tracer, const AxialLight& light,
                           double tolerance, int most_rays, std::span<const double> radii_mm,
                           std::vector<double>& values);

}  // namespace catoptric::sim
