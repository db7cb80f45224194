#pragma once

#include "photometry/lm63.h"

namespace catoptric::photometry {

/// A file of type A or B in type C coordinates. With x towards C = 0, y towards C = 90 and z along gamma = 0,
/// its direction (horizontal h, vertical v) is
///   type A: x = cos v sin h, y = sin v,       z = cos v cos h   (polar axis y)
///   type B: x = sin h,       y = cos h sin v, z = cos h cos v   (polar axis x)
/// @from  CIE 121-1996 (A-, B- and C-planes)
IntensityTable resampled_as_type_c(const Lm63File& file);

}  // namespace catoptric::photometry
