#pragma once

#include "sim/kernel.h"
#include "sim/recorded_area.h"

namespace catoptric::sim {

/// The share of the kernel's mass that lies on the recorded area, for an estimate at `plane_mm`: 1 inside,
/// about 1/2 on a straight edge, about 1/4 in a corner. Dividing an estimate by it makes an even field read
/// even up to the edge; a field with a slope keeps an error of the order of the radius there.
/// @in    plane_mm on the area
/// @error below 1e-9
/// @cost  nothing away from the edge, some microseconds near it
/// @from  Diggle 1985, A kernel method for smoothing point process data (end correction)
double kernel_mass_inside(Kernel kernel, double radius_mm, const RecordedArea& area, const Vector2& plane_mm);

}  // namespace catoptric::sim
