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

/// Whether the near field is a thing among others, from which light goes on to them.
inline bool near_field_sends_on(const Scene& scene) {
  const auto& material = scene.near_field.material();
  return !scene.is_bare() && material && surviving_share(*material) > 0;
}

/// Whether photons bring the direct light too: that of rays, and what goes through things on its way.
inline bool is_direct_sampled(const Scene& scene) {
  if (scene.source.is_sampled()) return true;
  if (scene.is_bare()) return false;
  const auto& material = scene.near_field.material();
  return scene.surroundings->lets_light_through() || (material && material->transmittance > 0);
}

/// Whether photons are recorded that never met the mirror, so that all must carry the same.
inline bool is_recorded_without_mirror(const Scene& scene) {
  return is_direct_sampled(scene) || near_field_sends_on(scene) ||
         (scene.surroundings && scene.surroundings->sends_light_on());
}

/// Whether light may reach the mirror or a field from anywhere, so that photons must go everywhere.
inline bool sends_everywhere(const Scene& scene) {
  const auto& material = scene.near_field.material();
  return is_recorded_without_mirror(scene) || (material && reflects(*material));
}

/// Whether something besides the mirror may stand between the source and a field.
inline bool may_shade(const Scene& scene) {
  return !scene.is_bare() && (scene.near_field.material() || scene.surroundings->may_shade());
}

}  // namespace catoptric::sim
