#include "sim/source.h"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.h"
#include "base/units.h"
#include "sim/projection_map.h"

namespace catoptric::sim {

PointSource::PointSource(const Vector3& position_mm, double power_w)
    : position_mm_(position_mm), power_w_(power_w) {
  if (!position_mm.allFinite())
    throw InputError({"the position is not finite", "source", "coordinates are finite numbers",
                      "write three finite numbers"});
  if (!(std::isfinite(power_w) && power_w >= 0))
    throw InputError({fmt::format("power of {} W", power_w), "source", "a power is finite and not negative",
                      "give it a positive power"});
}

double PointSource::power_into_w(const ProjectionMap& map) const {
  return map.solid_angle_sr() / (4 * pi) * power_w_;
}

Ray PointSource::emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const {
  return {position_mm_, map.direction(numbers[0], numbers[1])};
}

double PointSource::direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                                     double lift_mm) const {
  const Vector3 way = position_mm_ - point_mm;
  const double height_mm = way.dot(normal);
  if (!(height_mm > 0)) return 0;
  if (mirror.blocks(position_mm_, point_mm, lift_mm)) return 0;
  const double distance_mm = way.norm();
  // Divided step by step: the cube of a distance of kilometres or nanometres would leave the range early.
  return power_w_ / (4 * pi) * (height_mm / distance_mm) / distance_mm / distance_mm;
}

}  // namespace catoptric::sim
