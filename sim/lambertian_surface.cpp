#include "sim/lambertian_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/float_traps.h"
#include "sim/frame.h"

namespace catoptric::sim {

LambertianSurface::LambertianSurface(const Vector3& center_mm, const Vector3& axis, double power_w)
    : center_mm_(center_mm), power_w_(power_w) {
  check_source(center_mm, power_w, axis);
  frame_ = frame_about(unit_axis(axis));
}

void LambertianSurface::require_size(double size_mm, const char* what) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (!(std::isfinite(size_mm) && size_mm > 0))
    throw InputError({fmt::format("{} of {} mm", what, size_mm), "source",
                      "a source's size is positive and finite", "a point source needs none"});
}

double LambertianSurface::direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                                           double lift_mm) const {
  const double unhindered = unhindered_w_per_mm2(point_mm, normal);
  if (!(unhindered > 0)) return 0;
  // Rows of equal area, each turned against the last by the golden section: evener than chance, and fixed.
  const int places = probed_places();
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  double all = 0, free = 0;
  for (int i = 0; i < places; ++i) {
    const Place from = place((i + 0.5) / places, i * golden - std::floor(i * golden));
    const Vector3 way = from.point_mm - point_mm;
    const double square = way.squaredNorm();
    const double weight =
        std::max(0.0, way.dot(normal)) * std::max(0.0, -way.dot(from.normal)) / (square * square);
    all += weight;
    if (weight > 0 && !mirror.blocks(from.point_mm, point_mm, lift_mm)) free += weight;
  }
  return all > 0 ? unhindered * (free / all) : 0;
}

}  // namespace catoptric::sim
