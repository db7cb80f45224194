#include "sim/simulation.h"

#include <algorithm>
#include <array>

#include "base/profile.h"
#include "base/tolerance.h"
#include "sim/clear_view.h"
#include "sim/photon_fields.h"
#include "sim/side_by_side.h"

namespace catoptric::sim {
namespace {

/// A probe of a mirror that stands nowhere.
class OpenSpace final : public Probe {
 public:
  std::optional<Hit> first_hit(const Ray&, double) override { return std::nullopt; }
  std::vector<Hit> all_hits(const Ray&, double) override { return {}; }
};

/// What stands in the way of direct light: the mirror, and what is opaque about it.
class Shade final : public Probe {
 public:
  explicit Shade(const Scene& scene)
      : mirror_(scene.reflector.probe()), near_field_(scene.near_field), room_(*scene.surroundings) {}

  std::optional<Hit> first_hit(const Ray& ray, double beyond_mm) override {
    const auto hit = mirror_->first_hit(ray, beyond_mm);
    const Ray ahead{ray.origin_mm + beyond_mm * ray.direction, ray.direction};
    double reach_mm = hit ? hit->distance_mm - beyond_mm : HUGE_VAL;
    std::optional<double> stop;
    if (near_field_.material())
      for (const Arrival& arrival : near_field_.meet(ahead, false, reach_mm))
        if (near_field_.contains(arrival.plane_mm)) stop = reach_mm = arrival.distance_mm;
    if (const auto nearer = room_.first_opaque(ahead, reach_mm)) stop = nearer;
    if (!stop) return hit;
    const double distance_mm = *stop + beyond_mm;
    return Hit{distance_mm, ray.origin_mm + distance_mm * ray.direction, -ray.direction, 0};
  }

  std::vector<Hit> all_hits(const Ray& ray, double beyond_mm) override {
    const auto hit = first_hit(ray, beyond_mm);
    return hit ? std::vector{*hit} : std::vector<Hit>{};
  }

 private:
  std::unique_ptr<Probe> mirror_;
  const NearField& near_field_;
  const Surroundings& room_;
};

std::unique_ptr<Probe> shade_of(const Scene& scene) {
  if (may_shade(scene)) return std::make_unique<Shade>(scene);
  return scene.reflector.probe();
}

}  // namespace

std::vector<double> direct_field(const Scene& scene, std::span<const FieldSample> samples) {
  std::vector<double> direct(samples.size());
  if (is_direct_sampled(scene)) return direct;
  const Profile& profile = scene.reflector.profile();
  const double lift_mm = Tolerance::for_scale(profile.diagonal_mm()).lift_mm;
  const auto shine = [&](std::size_t i, Probe& probe) {
    return scene.source.direct_w_per_mm2(samples[i].point_mm, samples[i].normal, probe, lift_mm);
  };
  if (!may_shade(scene) &&
      is_view_clear(profile, scene.source.position_mm(), scene.source.extent_mm(), samples)) {
    for (std::size_t i = 0; i < samples.size(); ++i)
      direct[i] = scene.source.unhindered_w_per_mm2(samples[i].point_mm, samples[i].normal);
    return direct;
  }
  // One probe a chunk: engines may keep caches in it, and those must not depend on the number of threads.
  constexpr std::size_t chunk = 64;
  side_by_side((samples.size() + chunk - 1) / chunk, [&](std::size_t part) {
    const auto probe = shade_of(scene);
    for (std::size_t i = part * chunk; i < std::min(samples.size(), (part + 1) * chunk); ++i)
      direct[i] = shine(i, *probe);
  });
  return direct;
}

FieldEstimate simulate(const Scene& scene, std::span<const FieldSample> samples, const PhotonOptions& photons,
                       const EstimateOptions& estimate) {
  PhotonFields fields = photon_fields(scene, samples, photons, std::array{estimate});
  MapEstimate& reflected = fields.estimates.front();
  return {direct_field(scene, samples),
          std::move(reflected.irradiance),
          std::move(reflected.noise),
          std::move(reflected.kernel_radius_mm),
          fields.energy,
          fields.counts};
}

}  // namespace catoptric::sim
