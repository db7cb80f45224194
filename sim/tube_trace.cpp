#include "sim/tube_trace.h"

#include <cmath>

#include "base/tolerance.h"

namespace catoptric::sim {
namespace {

/// Mixes one more number into a path's name.
/// @from  finaliser of SplitMix64 (Steele, Lea & Flood 2014)
std::uint64_t mix(std::uint64_t path, std::uint64_t number) {
  std::uint64_t x = path * 0x9e3779b97f4a7c15ULL + number + 1;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

struct Direction {
  double r, z;
};

/// Unit tangent at an end of a span; from just inside where repeated poles leave it without speed.
Direction tangent(const RationalSpan& span, double s) {
  for (const double at : {s, s < 0.5 ? 1e-6 : 1 - 1e-6}) {
    const MeridianPoint point = evaluate(span, at);
    const double speed = std::hypot(point.dr, point.dz);
    if (speed > 0) return {point.dr / speed, point.dz / speed};
  }
  return {1, 0};
}

/// A ray that has met the mirror so often on all its paths together splits no more: a cavity of a
/// half-silvered mirror would have it grow without end.
constexpr int most_branching = 4096;

/// Directions nearer than this join smoothly: a turn of 1e-9 rad moves the landing by less than any tolerance
/// asked for, and adaptive tubes bear it.
constexpr double least_kink = 1e-9;

bool level_at_axis(const RationalSpan& span, double s) {
  return evaluate(span, s).r_mm == 0 && std::abs(tangent(span, s).z) < least_kink;
}

}  // namespace

struct TubeTracer::Path {
  PlanarRay ray;
  double apart, turn;  ///< the neighbouring ray: distance across and change of direction, per radian
  double weight;
  std::uint64_t name;
  int interactions;
};

TubeTracer::TubeTracer(const Profile& profile, double source_z_mm, const FieldPlane& plane,
                       const Material& mirror, const Limits& limits)
    : section_(profile),
      source_z_mm_(source_z_mm),
      plane_(plane),
      mirror_(mirror),
      limits_(limits),
      lift_mm_(Tolerance::for_scale(profile.diagonal_mm()).lift_mm),
      opening_(Opening::of(profile)) {
  const auto& spans = profile.spans();
  std::uint64_t run = 0;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    if (i > 0) {
      const Direction before = tangent(spans[i - 1], 1), after = tangent(spans[i], 0);
      if (!(std::abs(before.r * after.z - before.z * after.r) < least_kink &&
            before.r * after.r + before.z * after.z > 0))
        ++run;
    }
    smooth_run_.push_back(run);
    if (through_axis_.size() == run) through_axis_.push_back(false);
    if ((i == 0 && level_at_axis(spans[i], 0)) || (i + 1 == spans.size() && level_at_axis(spans[i], 1)))
      through_axis_[run] = true;
  }
}

std::uint64_t TubeTracer::surface_of(const PlanarHit& hit) const {
  const std::uint64_t run = smooth_run_[static_cast<std::size_t>(hit.span)];
  return 4 * run + (hit.side < 0 && !through_axis_[run] ? 2 : 0);
}

Dropped TubeTracer::trace(double theta_rad, std::vector<Landing>& landings) const {
  Dropped dropped;
  // The angle from the axis runs against the angle from x to z: the neighbour at theta + 1 rad turns by -1.
  follow({{0, source_z_mm_, std::sin(theta_rad), std::cos(theta_rad)}, 0, -1, 1, 0, 0}, landings, dropped);
  return dropped;
}

/// The meeting with the plane belongs to the stretch that ends on it, as for photons.
void TubeTracer::land(const Path& path, double reach_mm, std::vector<Landing>& landings) const {
  const double height = path.ray.z_mm - plane_.z_mm;
  if (!(height * path.ray.dz < 0) || (height > 0) != plane_.looks_up) return;
  const double distance = -height / path.ray.dz;
  if (!(distance <= reach_mm)) return;
  const double apart = path.apart + distance * path.turn;
  landings.push_back(
      {path.ray.x_mm + distance * path.ray.dx, -apart / path.ray.dz, path.weight, mix(path.name, 1)});
}

void TubeTracer::follow(Path path, std::vector<Landing>& landings, Dropped& dropped) const {
  for (;;) {
    if (path.interactions > 0 && opening_ &&
        opening_->lets_out(path.ray.x_mm, path.ray.z_mm, path.ray.dx, path.ray.dz))
      return land(path, HUGE_VAL, landings);
    const auto hit = section_.first_hit(path.ray, lift_mm_);
    if (path.interactions > 0) land(path, hit ? hit->distance_mm : HUGE_VAL, landings);
    if (!hit) return;
    if (path.interactions == limits_.most_interactions) {
      dropped.cut_off += path.weight;
      return;
    }
    ++path.interactions;
    ++dropped.interactions;
    // Across the ray, counter-clockwise from it.
    const double across_x = -path.ray.dz, across_z = path.ray.dx;
    const double apart = path.apart + hit->distance_mm * path.turn;
    const double slide = apart / (hit->tx * across_x + hit->tz * across_z);
    const std::uint64_t surface = surface_of(*hit);
    path.ray.x_mm = hit->x_mm;
    path.ray.z_mm = hit->z_mm;
    if (mirror_.transmittance > 0) {
      Path through = path;
      through.apart = apart;
      through.weight *= mirror_.transmittance;
      through.name = mix(path.name, surface + 1);
      if (mirror_.reflectance <= 0) {
        path = through;
        continue;
      }
      if (through.weight < limits_.least_weight || dropped.interactions > most_branching)
        dropped.faint += through.weight;
      else
        follow(through, landings, dropped);
    }
    path.weight *= mirror_.reflectance_at(std::abs(hit->tx * across_x + hit->tz * across_z));
    if (path.weight < limits_.least_weight) {
      dropped.faint += path.weight;
      return;
    }
    path.name = mix(path.name, surface);
    const double along = 2 * (path.ray.dx * hit->tx + path.ray.dz * hit->tz);
    const double dx = along * hit->tx - path.ray.dx, dz = along * hit->tz - path.ray.dz;
    const double length = std::hypot(dx, dz);
    path.ray.dx = dx / length;
    path.ray.dz = dz / length;
    path.turn = 2 * hit->curvature * slide - path.turn;
    path.apart = slide * (-hit->tx * path.ray.dz + hit->tz * path.ray.dx);
  }
}

}  // namespace catoptric::sim
