#include "design/stage.h"

#include "cad/engines.h"

namespace catoptric::design {
namespace {

std::unique_ptr<Reflector> make_reflector(const ModelSpec& model, const Profile& profile) {
  if (model.engine == Engine::occt) return cad::make_occt_reflector(profile);
  if (model.engine == Engine::mesh) return cad::make_mesh_reflector(profile, model.mesh);
  return cad::make_meridian_reflector(profile);
}

}  // namespace

Stage::Stage(const Scene& spec, const Candidate& candidate)
    : source(make_source(candidate.source)),
      mirror(make_reflector(spec.model, candidate.profile)),
      scene{*source, *mirror, candidate.mirror, spec.near_field, spec.surroundings.get()} {}

sim::ModelRequest model_request(const Scene& scene) {
  sim::ModelRequest request{scene.model.estimate, scene.model.rung, {}};
  if (scene.model.engine_asked_for) request.engine = std::string(name(scene.model.engine));
  return request;
}

}  // namespace catoptric::design
