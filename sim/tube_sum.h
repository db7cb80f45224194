#pragma once

#include <span>
#include <vector>

#include "sim/tube_map.h"

namespace catoptric::sim {

/// Adds the light of one tube to the field smoothed by the Silverman kernel.
///
/// The tube is cut where its landing radius turns and where a ring enters or leaves the kernel; between the
/// cuts everything is smooth and a Gauss-Legendre rule does.
/// @in    radii ascending; values as many
/// @error rule: below 1e-8 of the tube's share
/// @cost  some 20 ring kernels for each radius the tube reaches
void add_smoothed(const Tube& tube, double power_w, double kernel_radius_mm, std::span<const double> radii_mm,
                  std::vector<double>& values);

struct PointwiseSum {
  double error_w_per_mm2 = 0;
  int rays = 0;
};

/// Adds the pointwise irradiance of all branches, each found on the tubes and polished by Newton's method
/// with rays of its own.
/// @cost  two or three rays for each radius and branch
PointwiseSum add_pointwise(const TubeMap& map, const TubeTracer& tracer, double power_w, int most_rays,
                           std::span<const double> radii_mm, std::vector<double>& values);

}  // namespace catoptric::sim
