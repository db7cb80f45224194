#include "sim/light_paths.h"

#include <memory>
#include <utility>

#include "base/profile.h"
#include "base/tolerance.h"
#include "sim/emission.h"
#include "sim/opening.h"
#include "sim/photon_tracer.h"
#include "sim/recorded_area.h"

namespace catoptric::sim {

std::vector<LightPath> light_paths(const Scene& scene, const PhotonOptions& options) {
  check(options);
  const std::unique_ptr<const Emission> emission = emission_of(scene);
  const auto opening = Opening::of(scene.reflector.profile());
  const RecordedArea area = RecordedArea::about(scene.near_field, 0);
  const std::vector<RecordedArea> further_are_not_recorded;
  Flight flight{scene,
                options,
                *emission,
                area,
                opening,
                photon_key(options.seed, options.stream),
                Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm,
                false,
                scene.is_bare() ? nullptr : scene.surroundings,
                &further_are_not_recorded};
  std::vector<LightPath> paths(options.photons);
  flight.paths = &paths;
  trace_in_space(flight, 0, options.photons);
  return paths;
}

}  // namespace catoptric::sim
