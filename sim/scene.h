#pragma once

#include "base/ray.h"
#include "sim/material.h"
#include "sim/near_field.h"
#include "sim/source.h"
#include "sim/surroundings.h"

namespace catoptric::sim {

/// What the photons live in. Borrowed for the duration of a call.
struct Scene {
  const Source& source;
  const Reflector& reflector;
  Material mirror;
  const NearField& near_field;
  const Surroundings* surroundings = nullptr;  ///< null: nothing else is there

  /// Whether mirror and near field are all there is.
  bool is_bare() const { return !surroundings || surroundings->is_empty(); }
};

/// Whether photons bring the direct light too: that of rays, and what goes through things on its way.
inline bool is_direct_sampled(const Scene& scene) {
  return scene.source.is_sampled() || (scene.surroundings && scene.surroundings->lets_light_through());
}

/// Whether light may reach the mirror or a field from anywhere, so that photons must go everywhere.
inline bool sends_everywhere(const Scene& scene) {
  const auto& material = scene.near_field.material();
  return is_direct_sampled(scene) || (material && reflects(*material)) ||
         (scene.surroundings && scene.surroundings->sends_light_on());
}

}  // namespace catoptric::sim
