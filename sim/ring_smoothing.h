#pragma once

#include <span>
#include <vector>

#include "sim/ring_store.h"

namespace catoptric::sim {

/// Widest range in s = r^2 that one place may stand for under a disc kernel of this radius: on the axis,
/// where the kernel is (1 - s / h^2)^2, the midpoint rule then leaves 1e-4 of the value, and less elsewhere.
inline double widest_place_mm2(double kernel_radius_mm) { return kernel_radius_mm * kernel_radius_mm / 32; }

/// What a photon map of the same photons, at any azimuths, shows on average with a fixed radius: each place
/// is a ring, and a point sees the Silverman kernel's mean over it.
/// @in    photon_power_w of one photon; radii in the field; places rising
/// @out   W/mm^2 at the radii; the same bits for any number of threads
/// @cost  some 3 ns a radius and place within reach
std::vector<double> smoothed_rings(const RingStore::Places& places, double photon_power_w,
                                   std::span<const double> radii_mm, double kernel_radius_mm);

}  // namespace catoptric::sim
