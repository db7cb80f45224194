#pragma once

#include <span>

#include "sim/facet_field.h"
#include "sim/photon_map.h"

namespace catoptric::sim {

/// Irradiance at samples of a field of facets from the photons that landed on its lit side.
///
/// As paper eq. 8 with distances in space; the kernel's sum is divided by its integral over the facets, so
/// that neither edges nor curvature take light away: what is left of bias is that of smoothing along the
/// surface. Facets and photons whose side is turned by more than 60 degrees against the sample's do not
/// count: a thin body's other face, the next wall at a corner.
/// @in    landed: its photons in the field's sheet coordinates; samples as FacetField::places()
/// @out   as PhotonMap::estimate
/// @fails as check(options)
/// @error the integral is off by less than 1e-3 (smooth kernels; Kernel::constant 1e-2)
/// @cost  O(n log n) for a tree of the photons; a sample, its photons and some ten microseconds for the
///        integral, and some nanoseconds a facet
MapEstimate estimate_on_facets(const FacetField& field, const TracedPhotons& landed,
                               std::span<const FieldSample> samples, const EstimateOptions& options);

/// The kernel's integral over the facets about a place that looks to `normal`, mm^2: pi r^2 on a plane.
double kernel_integral_mm2(const FacetField& field, const Vector3& point_mm, const Vector3& normal,
                           Kernel kernel, double radius_mm);

}  // namespace catoptric::sim
