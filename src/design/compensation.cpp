#include "design/compensation.h"

#include <algorithm>
#include <cmath>

#include "base/ordered_sum.h"
#include "base/units.h"
#include "design/stage.h"
#include "sim/rings.h"

namespace catoptric::design {
namespace {

constexpr std::size_t nodes = 96;  ///< radii at which light is compared, even in area
constexpr int rounds = 8;          ///< of asking anew, for each size of the field
constexpr double damping = 0.7;    ///< whole corrections overshoot where images overlap
constexpr std::uint64_t photons = 65'536;
constexpr std::uint64_t sets = 4;

/// Wanted light by a table over the radius, straight between its entries.
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

/// Light of the real source by way of a mirror, W/mm^2.
struct RealLight {
  std::vector<double> reflected, noise;
};

class Feedback {
 public:
  Feedback(const Scene& scene, const TailoringTask& task, double image_mm)
      : scene_(scene), task_(task), image_mm_(image_mm) {
    const double reach_mm = scene.near_field.half_width_mm();
    for (std::size_t i = 0; i < nodes; ++i)
      radii_.push_back(reach_mm * std::sqrt((static_cast<double>(i) + 0.5) / nodes));
    for (const double radius_mm : radii_)
      wanted_.push_back(radius_mm <= task.wanted.end_mm ? task.wanted.w_per_mm2(radius_mm) : 0.0);
  }

  RealLight light_of(const Profile& profile) const {
    const Stage stage(scene_, profile);
    sim::RingsOptions options;
    options.photons.photons = photons;
    options.photons.sampler = sim::Sampler::sobol;
    options.photons.seed = scene_.seed;
    options.photons.stream = compensation_stream;
    options.replicates = sets;
    sim::RingsField field = sim::rings_field(stage.scene, radii_, options);
    return {std::move(field.debiased), std::move(field.debiased_noise)};
  }

  /// Relative root mean square over the area, of the whole light.
  double error_rel(const RealLight& light) const {
    double off = 0, all = 0;
    for (std::size_t i = 0; i < nodes; ++i) {
      const double wanted = std::max(0.0, wanted_[i]);
      off += (light.reflected[i] - wanted) * (light.reflected[i] - wanted);
      all += task_.total_w_per_mm2(radii_[i]) * task_.total_w_per_mm2(radii_[i]);
    }
    return std::sqrt(off / all);
  }

  double noise_rel(const RealLight& light) const {
    double noise = 0, all = 0;
    for (std::size_t i = 0; i < nodes; ++i) {
      noise += light.noise[i] * light.noise[i];
      all += task_.total_w_per_mm2(radii_[i]) * task_.total_w_per_mm2(radii_[i]);
    }
    return std::sqrt(noise / all);
  }

  /// The light to ask for next, from what came of the last.
  WantedLight asked_next(const WantedLight& last, const RealLight& light) const {
    std::vector<double> asked(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
      const double had = std::max(0.0, last.w_per_mm2(radii_[i]));
      asked[i] = had * std::clamp(std::pow(ratio_near(radii_[i], light), damping), 0.5, 2.0);
    }
    return {Table(radii_, std::move(asked)), last.breaks_mm, last.end_mm};
  }

 private:
  /// Wanted over had, both averaged over an image of the source.
  double ratio_near(double radius_mm, const RealLight& light) const {
    double wanted = 0, had = 0;
    for (std::size_t i = 0; i < nodes; ++i) {
      const double t = (radii_[i] - radius_mm) / (0.5 * image_mm_);
      const double weight = radii_[i] == radius_mm ? 1.0 : t * t < 1 ? 1 - t * t : 0.0;
      wanted += weight * std::max(0.0, wanted_[i]);
      had += weight * light.reflected[i];
    }
    return had > 0 && wanted > 0 ? wanted / had : 1.0;
  }

  static constexpr std::uint64_t compensation_stream = (std::uint64_t{1} << 35);  ///< nobody else's

  const Scene& scene_;
  const TailoringTask& task_;
  double image_mm_;
  std::vector<double> radii_, wanted_;
};

}  // namespace

Compensated compensate(const Scene& scene, const TailoringTask& task, const Profile& first, double image_mm,
                       const MirrorMaker& make) {
  const Feedback feedback(scene, task, image_mm);
  const RealLight at_first = feedback.light_of(first);
  Compensated best{first, feedback.error_rel(at_first), 0, 0, 1};
  best.error_rel = best.first_error_rel;
  best.noise_rel = feedback.noise_rel(at_first);
  // Images spill over the edge: a larger or smaller field may serve the target better.
  for (const double wider : {0.0, 0.5, 1.0, -0.5}) {
    const double end_mm = task.wanted.end_mm + wider * image_mm;
    if (!(end_mm > image_mm)) continue;
    WantedLight asked{[light = task.wanted.w_per_mm2, end = task.wanted.end_mm](double radius_mm) {
                        return light(std::min(radius_mm, end * (1 - 1e-9)));
                      },
                      task.wanted.breaks_mm, end_mm};
    for (int round = 0; round < rounds; ++round) {
      const auto profile = make(asked);
      if (!profile) break;
      const RealLight light = feedback.light_of(*profile);
      ++best.mirrors;
      const double error = feedback.error_rel(light);
      if (error < best.error_rel) {
        best.error_rel = error;
        best.noise_rel = feedback.noise_rel(light);
        best.profile = *profile;
      }
      asked = feedback.asked_next(asked, light);
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
