#pragma once

#include <memory>

#include "design/scene.h"
#include "sim/scene.h"
#include "sim/source.h"

namespace catoptric::design {

/// One mirror in the scene, ready for light: the source, and the mirror in the engine that the scene asks
/// for.
struct Stage {
  Stage(const Scene& spec, const Candidate& candidate);
  Stage(const Scene& spec, const Profile& profile) : Stage(spec, spec.with(profile)) {}
  std::unique_ptr<sim::Source> source;
  std::unique_ptr<Reflector> mirror;
  sim::Scene scene;
};

/// What the scene asks of the light besides: bandwidth, and the rung and engine that the user insists on.
sim::ModelRequest model_request(const Scene& scene);

}  // namespace catoptric::design
