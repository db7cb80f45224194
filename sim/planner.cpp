#include "sim/planner.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "sim/tubes.h"

namespace catoptric::sim {
namespace {

/// Why ray tubes cannot give what is asked for, in words, or nothing.
std::optional<std::string> objection_to_tubes(const Scene& scene, const EstimateOptions& estimate) {
  if (auto objection = tubes_objection(scene.source, scene.reflector.profile(), scene.near_field))
    return objection;
  if (estimate.neighbours) return "the estimate asks for a number of photons, and tubes have none";
  if (estimate.kernel != Kernel::silverman)
    return fmt::format("tubes are smoothed by the Silverman kernel, not by {}", name(estimate.kernel));
  return std::nullopt;
}

void describe(const Scene& scene, std::vector<Finding>& findings) {
  const Vector3& source_mm = scene.source.position_mm();
  const bool on_axis = source_mm.x() == 0 && source_mm.y() == 0;
  findings.push_back({"source", on_axis ? "a point on the axis" : "a point off the axis",
                      on_axis ? "rays stay in their meridian" : "rays leave their meridian"});
  findings.push_back({"mirror", "specular, of revolution", "nothing scatters there"});
  const double split = scene.mirror.transmittance > 0 && scene.mirror.reflectance > 0 ? 2 : 1;
  findings.push_back(
      {"losses",
       fmt::format("reflectance {}, transmittance {}", scene.mirror.reflectance, scene.mirror.transmittance),
       split > 1 ? "paths branch at every meeting" : "paths do not branch"});
  const bool across = scene.near_field.normal().head<2>().isZero();
  findings.push_back(
      {"near field", across ? "a plane across the axis" : "a tilted plane",
       across ? "irradiance depends on the distance from the axis alone" : "irradiance has no symmetry"});
  const auto& material = scene.near_field.material();
  findings.push_back({"near field's surface", material ? "real" : "invisible",
                      material && material->reflectance > 0 ? "its diffuse light may reach the mirror again"
                                                            : "no light returns from it"});
}

}  // namespace

std::string_view name(Rung rung) { return rung == Rung::tubes ? "tubes" : "photons"; }

Plan make_plan(const Scene& scene, const EstimateOptions& estimate, std::optional<Rung> wanted) {
  Plan plan;
  describe(scene, plan.findings);
  const auto objection = objection_to_tubes(scene, estimate);
  if (wanted == Rung::tubes && objection)
    throw InputError(
        {"rung tubes cannot light this scene", "model.rung", *objection, "model.rung = \"auto\""});
  if (wanted == Rung::photons) {
    plan.rung = Rung::photons;
    plan.findings.push_back(
        {"rung", "photons, as asked for",
         objection ? "tubes would not do: " + *objection : "tubes would do, without noise"});
  } else if (objection) {
    plan.rung = Rung::photons;
    plan.findings.push_back({"rung", "photons", "tubes would not do: " + *objection});
  } else {
    plan.rung = Rung::tubes;
    plan.findings.push_back({"rung", wanted ? "tubes, as asked for" : "tubes",
                             "no random numbers, no noise; the kernel's blur stays as asked for"});
  }
  return plan;
}

}  // namespace catoptric::sim
