#include "sim/intensity_source.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/units.h"
#include "sim/frame.h"
#include "sim/intensity_emission.h"

namespace catoptric::sim {
namespace {

constexpr double degrees = 180 / pi;

}  // namespace

IntensitySource::IntensitySource(const Vector3& position_mm, double power_w,
                                 std::shared_ptr<const IntensityTable> table, const Vector3& axis,
                                 const Vector3& along)
    : position_mm_(position_mm), power_w_(power_w), table_(std::move(table)) {
  check_source(position_mm, power_w, axis);
  const double flux = table_->flux();
  if (!(flux > 0))
    throw InputError(
        {"the table of intensities is dark", "source", "a source shines somewhere", "another file"});
  w_per_unit_ = power_w / flux;
  frame_ = table_->is_rotational() ? frame_about(unit_axis(axis)) : frame_along(unit_axis(axis), along);
}

double IntensitySource::intensity_w_per_sr(const Vector3& direction) const {
  const Vector3 local = frame_.transpose() * direction;
  const double gamma = std::atan2(std::hypot(local.x(), local.y()), local.z());
  return w_per_unit_ * table_->at(gamma * degrees, std::atan2(local.y(), local.x()) * degrees);
}

std::string IntensitySource::words() const {
  return fmt::format("a point with a table of {} intensities, {}", table_->values().size(),
                     table_->is_rotational() ? "alike round its axis" : "by gamma and C");
}

std::unique_ptr<Emission> IntensitySource::emission_to(const Profile& mirror) const {
  const ProjectionMap towards = ProjectionMap::towards(mirror, position_mm_);
  return std::make_unique<IntensityEmission>(position_mm_, frame_, *table_, &towards, power_w_);
}

std::unique_ptr<Emission> IntensitySource::emission() const {
  return std::make_unique<IntensityEmission>(position_mm_, frame_, *table_, nullptr, power_w_);
}

}  // namespace catoptric::sim
