#include "design/ray_output.h"

#include <cmath>
#include <vector>

#include "design/stage.h"
#include "rayfiles/zemax_header.h"
#include "sim/frame.h"
#include "sim/light_rays.h"

namespace catoptric::design {
namespace {

/// Streams that nothing else uses.
constexpr std::uint64_t ray_stream = std::uint64_t{1} << 38;

bool has_axis(const SourceSpec& spec) {
  if (spec.kind == SourceKind::point) return spec.exponent > 0;
  return spec.kind != SourceKind::sphere && spec.kind != SourceKind::several;
}

bool has_along(const SourceSpec& spec) {
  return spec.kind == SourceKind::rectangle || spec.kind == SourceKind::intensity ||
         spec.kind == SourceKind::rays;
}

sim::RayOptions ray_options(const Scene& scene, const RunControl& control) {
  return {scene.rays.count, scene.model.photons.sampler,           scene.seed,
          ray_stream,       scene.model.photons.most_interactions, control.stop};
}

}  // namespace

RayFrame own_frame(const SourceSpec& spec) {
  RayFrame frame;
  frame.origin_mm = spec.position_mm;
  if (has_along(spec))
    frame.axes = sim::frame_along(sim::unit_axis(spec.axis), spec.along);
  else if (has_axis(spec))
    frame.axes = sim::frame_about(sim::unit_axis(spec.axis));
  return frame;
}

RayOutput run_rays(const Scene& scene, const RunControl& control,
                   const std::function<void(std::span<const Ray>)>& take) {
  if (scene.rays.is_zemax && scene.rays.count > rayfiles::most_zemax_rays)
    throw scene.settings.error("rays.count", "is too large for the format",
                               "Zemax files hold 4,000,000,000 rays at most", "rays.format = \"tm25\"");
  const Stage stage(scene, start_candidate(scene));
  RayOutput result;
  if (!scene.rays.of_luminaire) result.frame = own_frame(start_candidate(scene).source);
  result.quantity = scene.source.quantity;
  result.source_flux = stage.source->power_w();
  result.emitted = scene.rays.count;
  result.ray_flux = result.source_flux / static_cast<double>(result.emitted);
  std::vector<Ray> turned;
  const auto in_frame = [&](std::span<const Ray> rays) {
    turned.clear();
    for (const Ray& ray : rays)
      turned.push_back({result.frame.axes.transpose() * (ray.origin_mm - result.frame.origin_mm),
                        result.frame.axes.transpose() * ray.direction});
    result.rays += turned.size();
    control.tell({"rays",
                  std::min(1.0, static_cast<double>(result.rays) / static_cast<double>(result.emitted)), NAN,
                  0});
    take(turned);
  };
  const sim::RayOptions options = ray_options(scene, control);
  if (scene.rays.of_luminaire)
    luminaire_rays(stage.scene, options, in_frame);
  else
    source_rays(*stage.source, options, in_frame);
  return result;
}

}  // namespace catoptric::design
