#include "design/far_field.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "design/evaluator.h"
#include "design/target_smoothing.h"

namespace catoptric::design {
namespace {

/// In diagonals of the mirror: near enough for doubles to tell its rays apart, to 1e-11 rad.
constexpr double distance_in_diagonals = 1e5;
/// Directions go round the axis by this angle, so that they are even in azimuth too.  @from Vogel 1979
constexpr double golden_angle_rad = 2.399963229728653;

/// Linear between the table's angles, level within the first and beyond the last: no direction is compared
/// there, but the kernel looks beyond.
double wanted_w_per_sr(const TargetSpec& spec, double angle_rad) {
  const std::vector<double>&angles = spec.angles_rad, &wanted = spec.intensities_w_per_sr;
  if (angle_rad > angles.back()) return wanted.back();
  if (angle_rad <= angles.front()) return wanted.front();
  const auto next =
      static_cast<std::size_t>(std::lower_bound(angles.begin(), angles.end(), angle_rad) - angles.begin());
  const double share = (angle_rad - angles[next - 1]) / (angles[next] - angles[next - 1]);
  return (1 - share) * wanted[next - 1] + share * wanted[next];
}

class Maker {
 public:
  explicit Maker(const Scene& scene)
      : spec_(scene.target),
        beam_(-scene.near_field.normal()),
        across_(scene.near_field.first_axis()),
        distance_mm_(distance_in_diagonals * scene.profile.diagonal_mm()),
        source_(make_source(scene.source)) {}

  FarField make(const Scene& scene) const {
    FarField far{scene, {}, {}};
    const double widest_mm = distance_mm_ * std::tan(spec_.angles_rad.back());
    far.scene.near_field =
        sim::NearField::disc(scene.source.position_mm + distance_mm_ * beam_, -beam_, widest_mm);
    far.scene.target = TargetSpec{};
    far.scene.fields.clear();
    if (scene.surroundings)
      far.scene.surroundings = std::make_shared<const sim::Surroundings>(scene.surroundings->luminaire());
    far.scene.target.free_scale = spec_.free_intensity;
    far.scene.grid = SampleGrid::area;
    far.scene.model.estimate.neighbours.reset();
    far.scene.model.estimate.kernel_radius_mm = distance_mm_ * std::tan(spec_.resolution_rad);
    far.target.through_kernel = far.target.intensities = true;
    add_directions(far);
    want(far);
    return far;
  }

 private:
  void add_directions(FarField& far) const {
    const double cap = 1 - std::cos(spec_.angles_rad.back());
    const auto count = static_cast<double>(far.scene.samples);
    for (std::size_t i = 0; i < far.scene.samples; ++i) {
      const double place = static_cast<double>(i) + 0.5;
      const double cosine = 1 - cap * place / count;
      const double radius_mm = distance_mm_ * std::sqrt(1 / (cosine * cosine) - 1);
      const double azimuth = golden_angle_rad * place;
      far.target.samples.push_back(
          {far.scene.near_field.to_space(radius_mm * Vector2(std::cos(azimuth), std::sin(azimuth))), -beam_});
      far.area_per_sr_mm2.push_back(distance_mm_ * distance_mm_ / (cosine * cosine * cosine));
    }
  }

  /// What the source sends straight into a direction; 0 where that depends on more than the angle, or the
  /// level of what is wanted is not known.
  double direct_w_per_sr(double angle_rad) const {
    if (source_->tilt_rad() > 0 || spec_.free_intensity) return 0;
    return source_->intensity_w_per_sr(std::cos(angle_rad) * beam_ + std::sin(angle_rad) * across_);
  }

  void want(FarField& far) const {
    std::vector<double> radii_mm, breaks_mm;
    for (const sim::FieldSample& sample : far.target.samples)
      radii_mm.push_back(far.scene.near_field.to_plane(sample.point_mm).norm());
    for (const double angle : spec_.angles_rad) breaks_mm.push_back(distance_mm_ * std::tan(angle));
    const auto from_mirror = [this](double radius_mm) {
      const double angle = std::atan(radius_mm / distance_mm_), cosine = std::cos(angle);
      const double mirror = wanted_w_per_sr(spec_, angle) - direct_w_per_sr(angle);
      return mirror * std::pow(cosine, 3) / (distance_mm_ * distance_mm_);
    };
    const sim::EstimateOptions& kernel = far.scene.model.estimate;
    far.target.irradiance_w_per_mm2 = far.as_intensity(
        kernel_means(from_mirror, breaks_mm, radii_mm, kernel.kernel, *kernel.kernel_radius_mm));
    for (std::size_t i = 0; i < radii_mm.size(); ++i)
      far.target.irradiance_w_per_mm2[i] += direct_w_per_sr(std::atan(radii_mm[i] / distance_mm_));
  }

  const TargetSpec& spec_;
  Vector3 beam_, across_;
  double distance_mm_;
  std::unique_ptr<sim::Source> source_;
};

}  // namespace

std::vector<double> FarField::as_intensity(std::vector<double> irradiance_w_per_mm2) const {
  for (std::size_t i = 0; i < irradiance_w_per_mm2.size(); ++i) irradiance_w_per_mm2[i] *= area_per_sr_mm2[i];
  return irradiance_w_per_mm2;
}

std::shared_ptr<const FarField> far_field(const Scene& scene) {
  if (scene.target.angles_rad.empty()) return nullptr;
  return std::make_shared<const FarField>(Maker(scene).make(scene));
}

std::vector<double> intensity_by_rung(const FarField& far, sim::Rung rung, const Candidate& candidate,
                                      std::uint64_t stream) {
  return far.as_intensity(total_by_rung(far.scene, rung, candidate, far.target.samples, stream));
}

}  // namespace catoptric::design
