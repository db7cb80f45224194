#include "sim/planner.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "base/errors.h"
#include "base/profile.h"
#include "base/units.h"
#include "sim/accuracy.h"
#include "sim/clear_view.h"
#include "sim/opening.h"
#include "sim/plane_flights.h"
#include "sim/rings.h"
#include "sim/tracer.h"
#include "sim/tubes.h"

namespace catoptric::sim {
namespace {

constexpr std::array<std::pair<Rung, std::string_view>, 3> rung_names{
    {{Rung::tubes, "tubes"}, {Rung::rings, "rings"}, {Rung::photons, "photons"}}};

std::optional<std::string> objection_to_tubes(const Scene& scene, const ModelRequest& request) {
  const EstimateOptions& estimate = request.estimate;
  if (!scene.is_bare()) return "other things stand about, which tubes do not meet";
  if (auto objection =
          tubes_objection(scene.source, scene.reflector.profile(), scene.mirror, scene.near_field))
    return objection;
  if (request.engine && *request.engine != "meridian")
    return fmt::format("tubes meet the mirror in its meridian, and engine {} was asked for", *request.engine);
  if (estimate.neighbours) return "the estimate asks for a number of photons, and tubes have none";
  if (estimate.kernel != Kernel::silverman)
    return fmt::format("tubes are smoothed by the Silverman kernel, not by {}", name(estimate.kernel));
  return std::nullopt;
}

std::optional<std::string> objection_to_rings(const Scene& scene, const EstimateOptions& estimate) {
  if (auto objection = rings_objection(scene)) return objection;
  if (estimate.neighbours)
    return "the estimate asks for a number of photons, and rings see none of them apart";
  if (estimate.kernel != Kernel::silverman)
    return fmt::format("rings are smoothed by the Silverman kernel, not by {}", name(estimate.kernel));
  return std::nullopt;
}

/// What the scene is, feature by feature.
class Description {
 public:
  explicit Description(const Scene& scene) : scene_(scene) {}

  std::vector<Finding> write(Rung rung) {
    source();
    mirror();
    near_field();
    more_meetings();
    if (!scene_.is_bare()) surroundings();
    if (!is_direct_sampled(scene_) && scene_.is_bare()) shadow();
    if (rung != Rung::tubes) {
      directions();
      jumps(rung);
    }
    return std::move(findings_);
  }

 private:
  void add(std::string feature, std::string found, std::string consequence) {
    findings_.push_back({std::move(feature), std::move(found), std::move(consequence)});
  }

  void source() {
    const Source& light = scene_.source;
    const Vector3& at_mm = light.position_mm();
    const bool on_axis = at_mm.x() == 0 && at_mm.y() == 0;
    const bool extended = light.extent_mm() > 0 || light.is_sampled();
    add("source", fmt::format("{} {} the axis", light.words(), on_axis ? "on" : "off"),
        !on_axis || extended    ? "rays leave their meridian plane: three dimensions"
        : light.tilt_rad() == 0 ? is_specular(scene_.mirror)
                                      ? "rays stay in their meridian plane: two dimensions are enough"
                                      : "rays leave their meridian plane at the mirror: three dimensions"
                                : "its axis is tilted: light differs from azimuth to azimuth");
    add("source's size", extended ? fmt::format("{:g} mm about its position", light.extent_mm()) : "none",
        (extended ? "photons start all over it; " : "left out: ") + light.left_out());
    if (extended && scene_.is_bare())
      add("lamp's own body", "none",
          "left out: light passes where the lamp is; a board or holder that stops it is an object "
          "([objects.NAME])");
  }

  void mirror() {
    const Material& mirror = scene_.mirror;
    const bool rough = mirror.reflectance > 0 && mirror.roughness > 0;
    if (rough)
      add("mirror", fmt::format("rough, GGX alpha {}, of revolution", mirror.roughness),
          "light spreads about the mirrored direction; what meets a second microfacet is lost");
    else if (is_specular(mirror))
      add("mirror", "specular, of revolution", "nothing scatters there; roughness is left out");
    else
      add("mirror", mirror.reflectance > 0 ? "partly matt, of revolution" : "matt, of revolution",
          "Lambert's law; the rest is mirrored without roughness");
    const bool branches = mirror.transmittance > 0 && reflects(mirror);
    std::string shares = fmt::format("reflectance {}", mirror.reflectance);
    if (mirror.diffuse > 0) shares += fmt::format(", diffuse {}", mirror.diffuse);
    add("losses", fmt::format("{}, transmittance {}", shares, mirror.transmittance),
        branches || !is_specular(mirror)                ? "paths branch at every meeting"
        : mirror.reflectance >= 1.0 && !mirror.by_angle ? "nothing is lost: no roulette is played"
                                                        : "paths do not branch");
    if (mirror.by_angle)
      add("reflectance by angle",
          fmt::format("{:.4g} head-on, {:.4g} at 60 degrees, {:.4g} grazing", mirror.reflectance_at(1),
                      mirror.reflectance_at(0.5), mirror.reflectance_at(0)),
          "unpolarised light, also after a meeting; polarisation is left out");
  }

  void near_field() {
    const bool across = scene_.near_field.normal().head<2>().isZero();
    add("near field", across ? "a plane across the axis" : "a tilted plane",
        across ? "with the source on the axis, upright, irradiance depends on the distance from it alone"
               : "irradiance has no symmetry about the axis");
    const auto& material = scene_.near_field.material();
    add("near field's surface", material ? "real" : "invisible",
        material && reflects(*material) ? "its light may reach the mirror again"
                                        : "no light returns from it");
  }

  void more_meetings() {
    const auto& material = scene_.near_field.material();
    const bool lets_out = Opening::of(scene_.reflector.profile()).has_value();
    add("second meetings",
        lets_out ? "a bowl, open to one side" : "a shape that may throw light back on itself",
        lets_out ? "light that leaves through the mouth is not followed to a second intersection"
                 : "every reflected ray is followed to its next meeting");
    if (material && !reflects(*material))
      add("light from the field", "absorbed or passed on", "left out: no diffuse light");
  }

  void surroundings() {
    for (const Object& object : scene_.surroundings->objects()) {
      if (object.glass)
        add(object.name, fmt::format("glass of index {:g}", object.glass->index),
            "Fresnel's law at its faces, both polarisations inside; dispersion is left out, its edges are "
            "black");
      else
        add(object.name,
            surviving_share(object.material) > 0 ? "a sheet that light goes on from" : "a black sheet",
            surviving_share(object.material) > 0 ? "photons go everywhere, not to the mirror alone"
                                                 : "it takes away what it meets");
    }
    for (const MoreField& more : scene_.surroundings->fields())
      add(more.name, more.field.material() ? "a further field, real" : "a further field, invisible",
          "a photon map of its own");
    if (is_direct_sampled(scene_))
      add("direct light", "some of it goes through things", "photons bring it too, with their noise");
    else if (may_shade(scene_))
      add("shadow on direct light", "things may stand between", "a ray to every sample asks for them too");
  }

  void shadow() {
    constexpr std::size_t places = 512;  // spread over the near field
    const bool clear = is_view_clear(scene_.reflector.profile(), scene_.source.position_mm(),
                                     scene_.source.extent_mm(), scene_.near_field.samples(places));
    add("shadow on direct light", clear ? "nothing can stand between" : "the mirror may stand between",
        clear ? "left out: no ray asks for it" : "a ray to every sample asks for it");
  }

  void directions() {
    if (scene_.source.is_sampled())
      return add("emission", "all rays of the source", "direct light comes by photons too");
    if (sends_everywhere(scene_) && !scene_.is_bare())
      return add("emission", "in all of the source's directions",
                 "light may come back from what stands about");
    const double power_w = scene_.source.power_w();
    const double share = power_w > 0 ? emission_of(scene_)->power_w() / power_w : 0;
    add("emission", fmt::format("{:.3g} of the light goes where the mirror may be met", share),
        "photons are sent nowhere else");
  }

  void jumps(Rung rung) {
    const KernelRange range = kernel_range(scene_, rung);
    add("jumps of the field",
        range.breaks ? *range.breaks
                     : fmt::format("none, nor within {:.3g} mm beside it", range.widest_radius_mm),
        range.breaks ? "an accuracy counts the kernel's bias as at a jump"
                     : "an accuracy counts the kernel's bias as a smooth field's");
  }

  const Scene& scene_;
  std::vector<Finding> findings_;
};

Finding rung_finding(Rung rung) {
  switch (rung) {
    case Rung::tubes:
      return {"rung", "tubes", "ray tubes in one meridian: no random numbers, no noise"};
    case Rung::rings:
      return {"rung", "rings", "photons folded about the axis: a density in one dimension, no photon map"};
    case Rung::photons:
      break;
  }
  return {"rung", "photons", "a photon map in three dimensions"};
}

Finding intersection_finding(const Scene& scene, Rung rung) {
  const std::string engine(scene.reflector.engine());
  const bool planar = rung == Rung::tubes || (rung == Rung::rings && PlaneFlights::possible(scene));
  return {"intersection", engine,
          planar ? "the ray against the generatrix in its meridian plane: half the degree"
                 : "the ray against the surface of revolution"};
}

}  // namespace

std::string_view name(Rung rung) {
  for (const auto& [each, text] : rung_names)
    if (each == rung) return text;
  return "";
}

std::optional<Rung> parse_rung(std::string_view text) {
  for (const auto& [rung, each] : rung_names)
    if (each == text) return rung;
  return std::nullopt;
}

std::optional<std::string> rung_objection(Rung rung, const Scene& scene, const ModelRequest& request) {
  if (rung == Rung::tubes) return objection_to_tubes(scene, request);
  if (rung == Rung::rings) return objection_to_rings(scene, request.estimate);
  return std::nullopt;
}

Plan make_plan(const Scene& scene, const ModelRequest& request) {
  Plan plan;
  std::vector<Finding> verdicts;
  bool chosen = false;
  for (const Rung rung : all_rungs) {
    const auto objection = rung_objection(rung, scene, request);
    if (objection && request.rung == rung)
      throw InputError({fmt::format("rung {} cannot light this scene", name(rung)), "model.rung", *objection,
                        "model.rung = \"auto\""});
    if (objection) {
      verdicts.push_back({fmt::format("rung {}", name(rung)), "not valid here", *objection});
    } else if (request.rung && request.rung != rung) {
      verdicts.push_back({fmt::format("rung {}", name(rung)), "valid",
                          fmt::format("not taken: {} was asked for", name(*request.rung))});
    } else if (chosen) {
      verdicts.push_back({fmt::format("rung {}", name(rung)), "valid", "not taken: dearer than needed"});
    } else {
      plan.rung = rung;
      chosen = true;
    }
  }
  plan.findings = Description(scene).write(plan.rung);
  plan.findings.insert(plan.findings.end(), verdicts.begin(), verdicts.end());
  plan.findings.push_back(rung_finding(plan.rung));
  plan.findings.push_back(intersection_finding(scene, plan.rung));
  return plan;
}

}  // namespace catoptric::sim
