#include "sim/ring_edges.h"

#include <algorithm>
#include <cmath>

#include "base/profile.h"
#include "base/tolerance.h"
#include "sim/scatter.h"

namespace catoptric::sim {
namespace {

double curvature(const MeridianPoint& at) {
  const double speed = std::hypot(at.dr, at.dz);
  return (at.dr * at.ddz - at.dz * at.ddr) / (speed * speed * speed);
}

/// Whether light on either side of the joint goes on differently. A joint that is smooth but taken for a jump
/// costs some noise, a jump taken for smooth is blurred: so rounding is given little room.
bool jumps(const MeridianPoint& before, const MeridianPoint& after, double size_mm) {
  constexpr double smooth = 1e-9;  // second derivatives of spans in Bernstein form are good to some 1e-12
  const double turn = before.dr * after.dz - before.dz * after.dr;
  const double speeds = std::hypot(before.dr, before.dz) * std::hypot(after.dr, after.dz);
  return !(std::abs(turn) <= smooth * speeds) ||
         !(std::abs(curvature(before) - curvature(after)) * size_mm <= smooth);
}

/// Places of the generatrix whose rays bound a bundle, with the tangent on each side.
std::vector<MeridianPoint> edges_of(const Profile& profile) {
  std::vector<MeridianPoint> edges;
  const double size_mm = profile.diagonal_mm(), on_axis_mm = Tolerance::for_scale(size_mm).length_mm;
  const auto& spans = profile.spans();
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const MeridianPoint first = evaluate(spans[i], 0), last = evaluate(spans[i], 1);
    if (i == 0 && first.r_mm > on_axis_mm) edges.push_back(first);
    if (i + 1 == spans.size()) {
      if (last.r_mm > on_axis_mm) edges.push_back(last);
      continue;
    }
    const MeridianPoint next = evaluate(spans[i + 1], 0);
    if (jumps(last, next, size_mm)) {
      edges.push_back(last);
      edges.push_back(next);
    }
  }
  return edges;
}

class EdgeRays {
 public:
  explicit EdgeRays(const Scene& scene)
      : scene_(scene),
        probe_(scene.reflector.probe()),
        lift_mm_(Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm) {}

  void start(const MeridianPoint& edge) {
    const Vector3 from = scene_.source.position_mm(), point(edge.r_mm, 0, edge.z_mm);
    const Vector3 normal = Vector3(edge.dz, 0, -edge.dr).normalized(), way = point - from;
    if (!normal.allFinite() || !(way.norm() > lift_mm_) || probe_->blocks(from, point, lift_mm_)) return;
    const Vector3 direction = way.normalized();
    if (scene_.mirror.reflectance > 0) follow({point, reflect(direction, normal)});
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
  EdgeRays rays(scene);
  for (const MeridianPoint& edge : edges_of(scene.reflector.profile())) rays.start(edge);
  return rays.take();
}

}  // namespace catoptric::sim
