#pragma once

#include <memory>

#include "base/profile.h"
#include "base/ray.h"

namespace catoptric::cad {

/// Engine "occt", the reference: OCCT's surface intersection, refined by Newton on the true surface.
/// @fails CadError when OCCT cannot build the surface
/// @cost  about 0.5 ms a ray
std::unique_ptr<Reflector> make_occt_reflector(const Profile& profile);

/// Engine "meridian", the default: the ray against the rational spans in the axis frame. No OCCT.
/// @cost  well under a microsecond a ray
std::unique_ptr<Reflector> make_meridian_reflector(const Profile& profile);

}  // namespace catoptric::cad
