#include "sim/ring_edges.h"

#include <cmath>

#include "base/tolerance.h"
#include "sim/scatter.h"
#include "sim/smooth_stretches.h"

namespace catoptric::sim {
namespace {

class EdgeRays {
 public:
  explicit EdgeRays(const Scene& scene)
      : scene_(scene),
        probe_(scene.reflector.probe()),
        lift_mm_(Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm) {}

  void start(const MeridianPoint& edge) {
    const Vector3 from = scene_.source.position_mm(), point(edge.r_mm, 0, edge.z_mm);
    const Vector3 normal = Vector3(edge.dz, 0, -edge.dr).normalized(), way = point - from;
    if (!normal.allFinite() || !(way.norm() > lift_mm_) ||
        !(scene_.source.intensity_w_per_sr(way.normalized()) > 0) || probe_->blocks(from, point, lift_mm_))
      return;
    const Vector3 direction = way.normalized();
    // A rough mirror blurs its edges, and a matt one has none to show.
    if (scene_.mirror.reflectance > 0 && !(scene_.mirror.roughness > 0))
      follow({point, reflect(direction, normal)});
    if (scene_.mirror.transmittance > 0) land({point, direction}, HUGE_VAL);
  }

  std::vector<double> take() { return std::move(squares_); }

 private:
  void follow(Ray ray) {
    constexpr int most_bounces = 64;  // later ones carry edges too faint or too many to treat apart
    for (int bounce = 0; bounce < most_bounces; ++bounce) {
      const auto hit = probe_->first_hit(ray, lift_mm_);
      land(ray, hit ? hit->distance_mm : HUGE_VAL);
      if (!hit) return;
      ray = {hit->point_mm, reflect(ray.direction, hit->normal)};
    }
  }

  void land(const Ray& ray, double reach_mm) {
    if (ray.direction.z() == 0) return;  // level, it lands nowhere
    const double distance_mm = (scene_.near_field.center_mm().z() - ray.origin_mm.z()) / ray.direction.z();
    if (!(distance_mm > 0 && distance_mm <= reach_mm)) return;
    squares_.push_back((ray.origin_mm + distance_mm * ray.direction).head<2>().squaredNorm());
  }

  const Scene& scene_;
  std::unique_ptr<Probe> probe_;
  double lift_mm_;
  std::vector<double> squares_;
};

}  // namespace

std::vector<double> edge_landing_squares(const Scene& scene) {
  if (scene.source.extent_mm() > 0) return {};  // whose edges of light are blurred
  EdgeRays rays(scene);
  for (const SmoothStretch& stretch : smooth_stretches(scene.reflector.profile())) {
    if (stretch.edge_at_begin) rays.start(stretch.begin);
    if (stretch.edge_at_end) rays.start(stretch.end);
  }
  return rays.take();
}

}  // namespace catoptric::sim
