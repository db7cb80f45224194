#pragma once

#include <atomic>

#include "design/scene.h"
#include "design/target.h"

namespace catoptric::design {

/// A scene and its target for a user who has stopped the run and waits.
struct InBrief {
  Scene scene;
  Target target;
};

/// The same with at most 1,048,576 photons and four replicates, and deaf to a stop: some seconds, however
/// long one evaluation of the scene takes.
InBrief in_brief(const Scene& scene, const Target& target);

/// The scene whose photons in flight are given up once `stop` is true.
Scene stoppable(Scene scene, const std::atomic<bool>* stop);

}  // namespace catoptric::design
