#include "base/planar_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/planar_roots.h"
#include "base/tolerance.h"

namespace catoptric {

/// The ray's line, its origin moved along it to where it passes nearest to the part's centre: what remains of
/// it is of the part's size, however far the source is.
struct PlanarMirror::Line {
  double x, z;  ///< z from the centre
  double dx, dz;
  double shift;  ///< distance along the given ray = shift + (point - (x, z)) . (dx, dz)
};

PlanarMirror::PlanarMirror(const Profile& profile)
    : degree_(profile.degree()),
      centre_z_mm_(0.5 * (profile.z_min_mm() + profile.z_max_mm())),
      diagonal_mm_(profile.diagonal_mm()),
      exact_(profile.spans()) {
  double r_extent = 0, z_extent = 0;
  for (const RationalSpan& from : profile.spans()) {
    Span span{};
    span.first = from.first;
    span.width = from.last - from.first;
    for (std::size_t i = 0; i < from.w.size(); ++i) {
      span.rw[i] = from.rw[i];
      span.w[i] = from.w[i];
      span.zw[i] = std::fma(-centre_z_mm_, from.w[i], from.zw[i]);
      r_extent = std::max(r_extent, std::abs(span.rw[i] / span.w[i]));
      z_extent = std::max(z_extent, std::abs(span.zw[i] / span.w[i]));
    }
    spans_.push_back(span);
  }
  size_mm_ = r_extent + z_extent;
  const std::size_t last = static_cast<std::size_t>(degree_);
  spans_.front().free_lo = spans_.front().rw[0] != 0;
  spans_.back().free_hi = spans_.back().rw[last] != 0;
}

template <typename Take>
void PlanarMirror::for_each_root(const Line& line, const Take& take) const {
  const std::size_t count = static_cast<std::size_t>(degree_) + 1;
  constexpr double roundoff = 0.5 * std::numeric_limits<double>::epsilon();
  // Roundings of one coefficient over its weight: two differences, two products, their sum, and the halvings,
  // each no larger than that of a number of the part's size.
  const double error = (8 + 2 * degree_) * roundoff * (size_mm_ + std::hypot(line.x, line.z));
  planar::SignedForm form;
  for (std::size_t index = 0; index < spans_.size(); ++index) {
    const Span& span = spans_[index];
    for (const int side : {1, -1}) {
      bool negative = false, positive = false, lies_in_surface = true;
      for (std::size_t i = 0; i < count; ++i) {
        const double w = span.w[i];
        form.a[i] = (span.zw[i] - line.z * w) * line.dx - (side * span.rw[i] - line.x * w) * line.dz;
        negative = negative || form.a[i] < 0;
        positive = positive || form.a[i] >= 0;
        lies_in_surface = lies_in_surface && std::abs(form.a[i]) <= error * w;
      }
      const bool touches_end = (span.free_lo && form.a[0] == 0) || (span.free_hi && form.a[count - 1] == 0);
      if ((!(negative && positive) && !touches_end) || lies_in_surface) continue;
      form.w = span.w;
      form.lo = 0;
      form.width = 1;
      form.free_lo = span.free_lo;
      form.free_hi = span.free_hi;
      const auto emit = [&](double s) { take(static_cast<int>(index), side, s); };
      if (degree_ == 2)
        planar::quadratic_roots(form, error, emit);
      else
        planar::RootFinder(degree_, error, emit).find(form);
    }
  }
}

namespace {

/// A ray through the part's neighbourhood, or no line at all when it passes far away.
template <typename Line>
Line near_line(const PlanarRay& ray, double centre_z, double size) {
  const double z = ray.z_mm - centre_z;
  const double shift = -(ray.x_mm * ray.dx + z * ray.dz);
  // From afar the product's own rounding would be larger than the part's.
  if (std::abs(shift) > size)
    return {std::fma(shift, ray.dx, ray.x_mm), std::fma(shift, ray.dz, ray.z_mm) - centre_z, ray.dx, ray.dz,
            shift};
  return {ray.x_mm + shift * ray.dx, z + shift * ray.dz, ray.dx, ray.dz, shift};
}

}  // namespace

PlanarHit PlanarMirror::hit_at(const Root& root) const {
  const std::size_t index = static_cast<std::size_t>(root.span);
  const RationalSpan& span = exact_[index];
  MeridianPoint point = evaluate(span, root.s);
  const double x = root.side * point.r_mm, z = point.z_mm;
  double speed = std::hypot(point.dr, point.dz);
  if (!(speed > Tolerance::for_scale(diagonal_mm_).length_mm)) {
    // Repeated poles leave the parametrization without speed at an end; a step inside it has the direction.
    // A millionth: the tangent there differs by as much, and the point is not used.
    point = evaluate(span, root.s < 0.5 ? root.s + 1e-6 : root.s - 1e-6);
    speed = std::hypot(point.dr, point.dz);
  }
  const double turn = (point.dr * point.ddz - point.dz * point.ddr) / (speed * speed * speed);
  return {root.distance_mm,
          x,
          z,
          root.side * point.dr / speed,
          point.dz / speed,
          root.side * turn,
          spans_[index].first + spans_[index].width * root.s,
          root.span,
          root.side};
}

std::optional<PlanarHit> PlanarMirror::first_hit(const PlanarRay& ray, double beyond_mm) const {
  const Line line = near_line<Line>(ray, centre_z_mm_, size_mm_);
  std::optional<Root> nearest;
  for_each_root(line, [&](int span, int side, double s) {
    const MeridianPoint point = evaluate(exact_[static_cast<std::size_t>(span)], s);
    const double distance = line.shift + (side * point.r_mm - line.x) * line.dx +
                            ((point.z_mm - centre_z_mm_) - line.z) * line.dz;
    if (distance > beyond_mm && (!nearest || distance < nearest->distance_mm))
      nearest = Root{distance, s, span, side};
  });
  if (!nearest) return std::nullopt;
  return hit_at(*nearest);
}

void PlanarMirror::all_hits(const PlanarRay& ray, double beyond_mm, std::vector<PlanarHit>& hits) const {
  hits.clear();
  const Line line = near_line<Line>(ray, centre_z_mm_, size_mm_);
  for_each_root(line, [&](int span, int side, double s) {
    const MeridianPoint point = evaluate(exact_[static_cast<std::size_t>(span)], s);
    const double distance = line.shift + (side * point.r_mm - line.x) * line.dx +
                            ((point.z_mm - centre_z_mm_) - line.z) * line.dz;
    if (distance > beyond_mm) hits.push_back(hit_at({distance, s, span, side}));
  });
  std::sort(hits.begin(), hits.end(),
            [](const PlanarHit& a, const PlanarHit& b) { return a.distance_mm < b.distance_mm; });
}

}  // namespace catoptric
