#include "design/brief.h"

#include <algorithm>

#include "design/far_field.h"

namespace catoptric::design {
namespace {

constexpr std::uint64_t photons_kept = 1'048'576, replicates_kept = 4;

void shorten(ModelSpec& model) {
  model.photons.stop = nullptr;
  model.photons.photons = std::min(model.photons.photons, photons_kept);
  model.replicates = std::min(model.replicates, replicates_kept);
}

}  // namespace

InBrief in_brief(const Scene& scene, const Target& target) {
  InBrief brief{scene, target};
  shorten(brief.scene.model);
  if (!target.far) return brief;
  FarField far = *target.far;
  shorten(far.scene.model);
  brief.target.far = std::make_shared<const FarField>(std::move(far));
  return brief;
}

Scene stoppable(Scene scene, const std::atomic<bool>* stop) {
  scene.model.photons.stop = stop;
  return scene;
}

}  // namespace catoptric::design
