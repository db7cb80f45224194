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

}  // namespace

std::vector<double> direct_field(const Scene& scene, std::span<const FieldSample> samples) {
  std::vector<double> direct(samples.size());
  const Profile& profile = scene.reflector.profile();
  const double lift_mm = Tolerance::for_scale(profile.diagonal_mm()).lift_mm;
  const auto shine = [&](std::size_t i, Probe& probe) {
    return scene.source.direct_w_per_mm2(samples[i].point_mm, samples[i].normal, probe, lift_mm);
  };
  if (is_view_clear(profile, scene.source.position_mm(), scene.source.extent_mm(), samples)) {
    for (std::size_t i = 0; i < samples.size(); ++i)
      direct[i] = scene.source.unhindered_w_per_mm2(samples[i].point_mm, samples[i].normal);
    return direct;
  }
  // One probe a chunk: engines may keep caches in it, and those must not depend on the number of threads.
  constexpr std::size_t chunk = 64;
  side_by_side((samples.size() + chunk - 1) / chunk, [&](std::size_t part) {
    const auto probe = scene.reflector.probe();
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
