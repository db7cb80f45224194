#pragma once

#include <span>
#include <vector>

#include "design/radial_target.h"
#include "sim/kernel.h"

namespace catoptric::design {

/// A function of the radius as the plane's kernel shows it: its mean about points at these radii.
/// @in    breaks_mm: where the function jumps or bends
/// @error relative 1e-6 of its greatest value; kernels other than Silverman's by the Silverman kernel of the
///        same second moment, which has the same blur where the function is smooth
/// @cost  some hundred values of the function and of the kernel's mean over a ring for each radius
std::vector<double> kernel_means(const std::function<double(double)>& function, std::vector<double> breaks_mm,
                                 std::span<const double> radii_mm, sim::Kernel kernel,
                                 double kernel_radius_mm);

}  // namespace catoptric::design
