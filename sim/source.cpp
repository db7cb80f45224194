#include "sim/source.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/float_traps.h"
#include "base/units.h"
#include "sim/projection_map.h"

namespace catoptric::sim {
namespace {

class MapEmission final : public Emission {
 public:
  MapEmission(const MappedSource& source, ProjectionMap map)
      : source_(source), map_(std::move(map)), power_w_(source.power_into_w(map_)) {}
  double power_w() const override { return power_w_; }
  std::size_t numbers() const override { return source_.emission_numbers(); }
  Ray emit(const std::array<double, 4>& numbers, std::uint64_t) const override {
    return source_.emit(map_, numbers);
  }
  const ProjectionMap* directions() const override { return source_.extent_mm() == 0 ? &map_ : nullptr; }

 private:
  const MappedSource& source_;
  ProjectionMap map_;
  double power_w_;
};

}  // namespace

std::unique_ptr<Emission> MappedSource::emission_to(const Profile& mirror) const {
  return std::make_unique<MapEmission>(*this, directions_to(mirror));
}

std::unique_ptr<Emission> MappedSource::emission() const {
  return std::make_unique<MapEmission>(*this, all_directions());
}

ProjectionMap MappedSource::directions_to(const Profile& mirror) const {
  return ProjectionMap::towards(mirror, emitter());
}

ProjectionMap MappedSource::all_directions() const { return ProjectionMap::all_lit(emitter()); }

double MappedSource::power_into_w(const ProjectionMap& map) const {
  return map.light_sr() / emitter().law.total_sr() * power_w();
}

void check_source(const Vector3& position_mm, double power_w, const Vector3& axis) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (!position_mm.allFinite())
    throw InputError({"the position is not finite", "source", "coordinates are finite numbers",
                      "write three finite numbers"});
  if (!(std::isfinite(power_w) && power_w >= 0))
    throw InputError({fmt::format("power of {} W", power_w), "source", "a power is finite and not negative",
                      "give it a positive power"});
  if (!(axis.allFinite() && axis.stableNorm() > 0))
    throw InputError({"the axis has no direction", "source", "it is a finite vector, not zero", "[0, 0, 1]"});
}

Vector3 unit_axis(const Vector3& axis) {
  const UntrappedFloats untrapped;  // what has no direction is refused later
  return axis.stableNormalized();
}

double tilt_of(const Vector3& axis) { return std::atan2(std::hypot(axis.x(), axis.y()), std::abs(axis.z())); }

PointSource::PointSource(const Vector3& position_mm, double power_w, double exponent, const Vector3& axis)
    : position_mm_(position_mm), power_w_(power_w), law_{exponent}, axis_(unit_axis(axis)) {
  check_source(position_mm, power_w, axis);
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (!(exponent >= 0 && exponent <= greatest_exponent))
    throw InputError(
        {fmt::format("exponent of {}", exponent), "source",
         fmt::format("the exponent of the intensity's cosine lies between 0 and {}", greatest_exponent),
         "1 is Lambert's law, 0 the same in all directions"});
}

double PointSource::tilt_rad() const { return law_.is_even() ? 0 : tilt_of(axis_); }

double PointSource::intensity_w_per_sr(const Vector3& direction) const {
  if (law_.is_even()) return power_w_ / (4 * pi);
  return power_w_ / law_.total_sr() * law_(direction.dot(axis_));
}

std::string PointSource::words() const {
  return law_.is_even() ? "a point" : fmt::format("a point with intensity like cosine^{:g}", law_.exponent);
}

Emitter PointSource::emitter() const { return {position_mm_, 0, law_, axis_}; }

Ray PointSource::emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const {
  return {position_mm_, map.direction(numbers[0], numbers[1])};
}

double point_irradiance_w_per_mm2(const Source& point, const Vector3& place_mm, const Vector3& normal) {
  const Vector3 way = point.position_mm() - place_mm;
  const double height_mm = way.dot(normal);
  if (!(height_mm > 0)) return 0;
  const double distance_mm = way.norm();
  // Divided step by step: the cube of a distance of kilometres or nanometres would leave the range early.
  return point.intensity_w_per_sr(-way / distance_mm) * (height_mm / distance_mm) / distance_mm / distance_mm;
}

double point_direct_w_per_mm2(const Source& point, const Vector3& place_mm, const Vector3& normal,
                              Probe& mirror, double lift_mm) {
  const double unhindered = point_irradiance_w_per_mm2(point, place_mm, normal);
  return unhindered > 0 && mirror.blocks(point.position_mm(), place_mm, lift_mm) ? 0 : unhindered;
}

}  // namespace catoptric::sim
