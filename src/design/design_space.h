#pragma once

#include <vector>

#include "design/candidate.h"
#include "design/scene.h"

namespace catoptric::design {

/// The mirrors that the scene's variables reach: named components of a fixed profile, a whole free profile,
/// or one given by its curvature, as `search.free` says.
ShapeFamily shape_family(const Scene& scene);

/// The variables of `search.free` "profile" and "curvature" for a profile, then those listed beside the
/// shape. Step and bounds of a listed variable are taken over by the free one of the same name; those of a
/// weight, as logarithms, by logw.
/// @fails InputError
std::vector<optim::Variable> free_variables(const Profile& profile, const SearchSpec& search,
                                            const std::vector<optim::Variable>& listed);

}  // namespace catoptric::design
