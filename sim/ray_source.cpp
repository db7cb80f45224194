#include "sim/ray_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/frame.h"

namespace catoptric::sim {
namespace {

class BundleEmission final : public Emission {
 public:
  BundleEmission(const RayBundle& rays, const Vector3& position_mm, const Eigen::Matrix3d& frame,
                 double power_w)
      : rays_(rays), position_mm_(position_mm), frame_(frame), power_w_(power_w) {
    // Pieces of some eight rays in each part: fewer would share most of their rays with a neighbour.
    constexpr std::uint64_t rays_of_a_piece = 8;
    rounds_ =
        static_cast<double>(std::max<std::uint64_t>(1, rays.count() / (parts_of_a_bundle * rays_of_a_piece)));
  }
  double power_w() const override { return power_w_; }
  std::size_t numbers() const override { return 1; }

  Ray emit(const std::array<double, 4>& numbers, std::uint64_t stream) const override {
    const Ray ray =
        rays_.pick(stream == 0 ? numbers[0] : of_part(numbers[0], (stream - 1) % parts_of_a_bundle));
    return {position_mm_ + frame_ * ray.origin_mm, frame_ * ray.direction};
  }

 private:
  /// A number that picks from one part: pieces of all parts follow each other, round after round, since files
  /// are often sorted.
  double of_part(double number, std::uint64_t part) const {
    const double along = number * rounds_, round = std::min(std::floor(along), rounds_ - 1);
    const double inside =
        (static_cast<double>(part) + (along - round)) / static_cast<double>(parts_of_a_bundle);
    constexpr double last = 1 - 0x1p-53;
    return std::min((round + inside) / rounds_, last);
  }

  const RayBundle& rays_;
  Vector3 position_mm_;
  Eigen::Matrix3d frame_;
  double power_w_, rounds_;
};

}  // namespace

RaySource::RaySource(const Vector3& position_mm, double power_w, std::shared_ptr<const RayBundle> rays,
                     const Vector3& axis, const Vector3& along)
    : position_mm_(position_mm), power_w_(power_w), rays_(std::move(rays)) {
  check_source(position_mm, power_w, axis);
  frame_ = frame_along(unit_axis(axis), along);
}

std::string RaySource::words() const { return fmt::format("{} measured rays", rays_->count()); }

std::string RaySource::left_out() const {
  return "direct light comes by photons as well; noise falls no lower than that of the file's own rays";
}

std::unique_ptr<Emission> RaySource::emission() const {
  return std::make_unique<BundleEmission>(*rays_, position_mm_, frame_, power_w_);
}

}  // namespace catoptric::sim
