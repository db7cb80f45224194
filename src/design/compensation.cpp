#include "design/compensation.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "design/image_blur.h"
#include "design/stage.h"
#include "sim/rings.h"

namespace catoptric::design {
namespace {

constexpr std::size_t compared_radii = 96;              ///< radii at which light is compared, even in area
constexpr std::uint64_t photons_of_all_sets = 262'144;  ///< in all sets
constexpr std::uint64_t sets = 4;
constexpr std::uint64_t own_stream = std::uint64_t{1} << 36;  ///< nobody else's photons
/// Wanted light is sharpened by so many rounds before a mirror is made for it: what is too sharp for a spline
/// of few points, or for images that are not alike, shows in the real light.
constexpr int sharpenings[] = {3, 10, 30, 100, 300};
constexpr int rounds = 5;  ///< of correction by the real light, after each sharpening

/// Straight between a table's entries, level beyond them.
class Table {
 public:
  Table(std::vector<double> radii_mm, std::vector<double> values)
      : radii_(std::move(radii_mm)), values_(std::move(values)) {}

  double operator()(double radius_mm) const {
    if (radius_mm <= radii_.front()) return values_.front();
    if (radius_mm >= radii_.back()) return values_.back();
    const auto next =
        static_cast<std::size_t>(std::upper_bound(radii_.begin(), radii_.end(), radius_mm) - radii_.begin());
    const double share = (radius_mm - radii_[next - 1]) / (radii_[next] - radii_[next - 1]);
    return (1 - share) * values_[next - 1] + share * values_[next];
  }

 private:
  std::vector<double> radii_, values_;
};

std::vector<double> radii_over(double reach_mm) {
  std::vector<double> radii;
  for (std::size_t i = 0; i < compared_radii; ++i)
    radii.push_back(reach_mm * std::sqrt((static_cast<double>(i) + 0.5) / compared_radii));
  return radii;
}

double norm_per_sample(const Eigen::VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

/// Light of the real source by way of a mirror, W/mm^2, and its noise.
struct RealLight {
  Eigen::VectorXd reflected, noise;
};

class Feedback {
 public:
  Feedback(const Scene& scene, const TailoringTask& task, double image_mm)
      : scene_(scene),
        radii_(radii_over(scene.near_field.half_width_mm())),
        blur_(radii_, image_mm),
        wanted_(static_cast<Eigen::Index>(compared_radii)) {
    Eigen::VectorXd total(static_cast<Eigen::Index>(compared_radii));
    for (std::size_t i = 0; i < compared_radii; ++i) {
      const bool within = radii_[i] <= task.wanted.end_mm;
      wanted_[static_cast<Eigen::Index>(i)] = within ? std::max(0.0, task.wanted.w_per_mm2(radii_[i])) : 0.0;
      total[static_cast<Eigen::Index>(i)] = task.total_w_per_mm2(radii_[i]);
    }
    total_rms_ = norm_per_sample(total);
  }

  /// Why the light is looked at on a bare plane instead of the scene's near field; nothing where it is not.
  static std::optional<std::string> left_out(const Scene& scene, const Profile& profile) {
    return sim::rings_objection(Stage(scene, profile).scene);
  }

  RealLight light_of(const Profile& profile) const {
    const Stage stage(scene_, profile);
    const sim::NearField plane = sim::NearField::disc({0, 0, scene_.near_field.center_mm().z()},
                                                      scene_.near_field.normal(), radii_.back() * 1.01);
    const sim::Scene bare{*stage.source, *stage.mirror, stage.scene.mirror, plane, nullptr};
    const sim::Scene& seen = sim::rings_objection(stage.scene) ? bare : stage.scene;
    sim::RingsOptions options;
    options.photons.photons = photons_of_all_sets;
    options.photons.sampler = sim::Sampler::sobol;
    options.photons.seed = scene_.seed;
    options.photons.stream = own_stream;
    options.replicates = sets;
    const sim::RingsField field = sim::rings_field(seen, radii_, options);
    const auto copied = [](const std::vector<double>& values) {
      return Eigen::VectorXd(
          Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(compared_radii)));
    };
    return {copied(field.debiased), copied(field.debiased_noise)};
  }

  double error_rel(const RealLight& light) const {
    return norm_per_sample(light.reflected - wanted_) / total_rms_;
  }
  double noise_rel(const RealLight& light) const { return norm_per_sample(light.noise) / total_rms_; }
  double limit_rel() const { return blur_.limit(wanted_) / total_rms_; }

  /// Where images must be put, by the model of images that are all alike.
  Eigen::VectorXd sharpened(int times) const {
    return blur_.improved(wanted_, blur_.even_powers(wanted_), times);
  }
  Eigen::VectorXd corrected(Eigen::VectorXd powers, const RealLight& light) const {
    powers.array() *= blur_.factors(wanted_, light.reflected).array();
    return powers;
  }

  /// The powers as light that a point source's mirror can be asked for.
  WantedLight asked(const Eigen::VectorXd& powers) const {
    constexpr double faint = 1e-3;  // of the brightest: not worth a piece of mirror
    std::vector<double> densities = blur_.densities(powers);
    const double brightest = *std::max_element(densities.begin(), densities.end());
    std::size_t last = densities.size();
    while (last > 1 && densities[last - 1] < faint * brightest) --last;
    const double width_mm = blur_.ring_radii_mm().front() * 2;
    const double end_mm = blur_.ring_radii_mm()[last - 1] + 0.5 * width_mm;
    return {Table(blur_.ring_radii_mm(), std::move(densities)), {}, end_mm};
  }

 private:
  const Scene& scene_;
  std::vector<double> radii_;
  ImageBlur blur_;
  Eigen::VectorXd wanted_;  ///< of the mirror
  double total_rms_ = 0;    ///< of the target, direct light included
};

}  // namespace

Compensated compensate(const Scene& scene, const TailoringTask& task, const Profile& first, double image_mm,
                       const MirrorMaker& make) {
  const Feedback feedback(scene, task, image_mm);
  const RealLight at_first = feedback.light_of(first);
  Compensated best{first, feedback.error_rel(at_first),    0, 0, feedback.limit_rel(),
                   1,     Feedback::left_out(scene, first)};
  best.error_rel = best.first_error_rel;
  best.noise_rel = feedback.noise_rel(at_first);
  for (const int times : sharpenings) {
    Eigen::VectorXd powers = feedback.sharpened(times);
    for (int round = 0; round < rounds; ++round) {
      const auto profile = make(feedback.asked(powers));
      if (!profile) break;
      const RealLight light = feedback.light_of(*profile);
      ++best.mirrors;
      if (const double error = feedback.error_rel(light); error < best.error_rel) {
        best.error_rel = error;
        best.noise_rel = feedback.noise_rel(light);
        best.profile = *profile;
      }
      powers = feedback.corrected(std::move(powers), light);
    }
  }
  return best;
}

ImageRange source_images(const AxialLayout& layout, double source_radius_mm, const Profile& profile) {
  ImageRange range{HUGE_VAL, 0};
  constexpr int places = 64;
  for (int i = 0; i <= places; ++i) {
    const double share = static_cast<double>(i) / places;
    const MeridianPoint at = profile.at(profile.first_parameter() +
                                        share * (profile.last_parameter() - profile.first_parameter()));
    const double to_source = std::hypot(at.r_mm, at.z_mm - layout.source_z_mm);
    const double to_field = std::abs(at.z_mm - layout.field_z_mm);
    const double image = source_radius_mm * to_field / to_source;
    range.least_mm = std::min(range.least_mm, image);
    range.most_mm = std::max(range.most_mm, image);
  }
  return range;
}

}  // namespace catoptric::design
