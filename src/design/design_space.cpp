#include "design/design_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::design {
namespace {

void take_over(optim::Variable& variable, const optim::Variable& listed) {
  variable.step = listed.step;
  variable.lower = std::min(listed.lower, variable.start);
  variable.upper = std::max(listed.upper, variable.start);
}

/// A listed weight as the logarithm that the free profile moves.
optim::Variable as_logarithm(optim::Variable weight) {
  weight.step = std::abs(std::log1p(weight.step / weight.start));
  weight.lower = std::log(weight.lower);
  weight.upper = std::log(weight.upper);
  return weight;
}

}  // namespace

ShapeFamily shape_family(const Scene& scene) {
  if (scene.search.free == Freedom::profile) return FreeProfile(scene.profile, scene.search.free_profile);
  if (scene.search.free == Freedom::curvature) return CurvatureProfile(scene.profile, scene.search.curvature);
  std::vector<std::string> shape;
  for (const optim::Variable& variable : scene.variables)
    if (!parse_scene_variable(variable.name)) shape.push_back(variable.name);
  return ProfileFamily(scene.profile, shape, scene.unit);
}

std::vector<optim::Variable> free_variables(const Profile& profile, const SearchSpec& search,
                                            const std::vector<optim::Variable>& listed) {
  std::vector<optim::Variable> list = search.free == Freedom::curvature
                                          ? CurvatureProfile(profile, search.curvature).variables()
                                          : FreeProfile(profile, search.free_profile).variables();
  if (search.free == Freedom::profile)
    for (optim::Variable& variable : list)
      for (const optim::Variable& other : listed) {
        if (variable.name == other.name) take_over(variable, other);
        if (variable.name == "log" + other.name) take_over(variable, as_logarithm(other));
      }
  for (const optim::Variable& other : listed)
    if (parse_scene_variable(other.name)) list.push_back(other);
  return list;
}

}  // namespace catoptric::design
