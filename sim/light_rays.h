#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>

#include "base/ray.h"
#include "sim/emission.h"
#include "sim/scene.h"

namespace catoptric::sim {

/// Which rays stand for a light. All of them carry the same power: that of the source over `count`.
struct RayOptions {
  std::uint64_t count = 1'000'000;  ///< that the source sends out
  Sampler sampler = Sampler::sobol;
  std::uint64_t seed = 1;
  std::uint64_t first_stream = 0;  ///< batches take this stream and those that follow
  int most_interactions = 1000;
  const std::atomic<bool>* stop = nullptr;  ///< true: given up with Interrupted
};

/// Takes rays in their final order, batch after batch.
using TakeRays = std::function<void(std::span<const Ray>)>;

/// All rays that a source sends out, as if nothing stood about it. Rays that stand next to each other have
/// nothing to do with each other, so that a part of them is a fair sample of all.
/// @out   the same bits for any number of threads
/// @fails Interrupted
/// @cost  memory for 2^20 rays, whatever the count
void source_rays(const Source& source, const RayOptions& options, const TakeRays& take);

/// The same of a luminaire: what of the source's rays leaves it and its mirror for good, from where each last
/// left one of them; the near field is left out. Fewer than `count` where the mirror absorbs.
/// @fails as depart()
void luminaire_rays(const Scene& scene, const RayOptions& options, const TakeRays& take);

}  // namespace catoptric::sim
