#pragma once

#include <memory>

#include "base/profile.h"
#include "base/ray.h"

namespace catoptric::cad {

/// Engine "occt", the reference: OCCT's surface intersection, refined by Newton on the true surface. A probe
/// lives no longer than its reflector.
/// @fails CadError when OCCT cannot build the surface
/// @error hits to some roundings of the part's size; two hits nearer than 1e-9 of it (a grazing ray) may come
///        back as one
/// @cost  about 0.35 ms a ray
std::unique_ptr<Reflector> make_occt_reflector(const Profile& profile);

/// Engine "meridian", the default: the ray against the rational spans in the axis frame. No OCCT. A probe
/// lives no longer than its reflector.
///
/// Every root is found and none invented: signs count only beyond a rounding bound, and a ray that double
/// cannot decide (tangent to rounding, through the vertex or the rim exactly) is done again in 113 bits. A
/// touch counts once; a ray that lies in the surface meets it nowhere; the rim belongs to the mirror. At the
/// tip of a cone, which has no normal, the normal is that of the ray's own meridian plane.
/// @error hit and ray, hit and surface: within some ten roundings of the part's size at any incidence
/// @cost  0.2 to 0.6 us a ray for a few spans (growing with their logarithm); 0.01 to 4 ms for those in 113
/// bits
std::unique_ptr<Reflector> make_meridian_reflector(const Profile& profile);

}  // namespace catoptric::cad
