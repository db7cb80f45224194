#pragma once

#include <memory>
#include <optional>

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
///
/// first_hits gives each ray the hit of first_hit, bit for bit, in whatever batch and on whatever processor:
/// rays in no need of more than certain signs and Newton's method go four at a time, the others one by one.
/// @cost  0.2 to 0.6 us a ray for a few spans (growing with their logarithm), in batches of eight or more
/// 0.07
///        to 0.35 us on a processor with AVX2; 0.01 to 4 ms for those in 113 bits
std::unique_ptr<Reflector> make_meridian_reflector(const Profile& profile);

/// How near engine "mesh" follows the mirror.
struct MeshOptions {
  /// Greatest distance of a facet from the true surface, over the part's diagonal; 1e-6 to 0.05. The facets
  /// stand on both sides of it.
  double chord_error = 1e-4;
  /// In mm instead, the same range of the part.
  std::optional<double> chord_error_mm;
  /// Newton's method stops when ray and surface are this near each other, over the part's diagonal. From the
  /// chord error on (1, say) nothing is refined: the parameter is the one interpolated on the facet, and
  /// point and normal are the generatrix's there.
  double newton_tolerance = 1e-14;
};

/// Engine "mesh", a peer for the trade of time against error: triangles asked by Embree, each hit refined by
/// Newton's method onto the true surface. A probe lives no longer than its reflector.
///
/// It finds what its facets find. A ray that grazes the surface within the chord error of it may pass beside
/// the facets: the hit is lost, or a later one taken for the first. Lost of a million rays on the paper's
/// paraboloid at 1e-4: none of the focus, of all directions, or along the axis up to the rim; 9500 of those
/// that come from far to graze it (README.md). No hit is invented: what does not come onto the surface is
/// dropped. Batches are answered ray by ray, since Embree's packets of 4, 8 and 16 rays gain nothing here.
/// @fails InputError for options out of range, or for more than 4 million triangles; CadError when Embree
///        cannot start
/// @error hits to newton_tolerance, not less than some ten roundings, of the part's size over the cosine of
///        incidence
/// @cost  0.4 to 0.6 us a ray for 8000 triangles, which take 1 MB and some ms to build
std::unique_ptr<Reflector> make_mesh_reflector(const Profile& profile, const MeshOptions& options = {});

}  // namespace catoptric::cad
