#include "sim/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/errors.h"
#include "base/ordered_sum.h"
#include "sim/bandwidth_ladder.h"
#include "sim/ladder_error.h"
#include "sim/simulation.h"
#include "sim/tubes.h"

namespace catoptric::sim {
namespace {

constexpr std::uint64_t sets = 4;             ///< fewer give no spread, more waste the points' evenness
constexpr std::uint64_t first_photons = 512;  ///< of a set: enough for a forecast
constexpr std::size_t most_probes = 2048;     ///< samples by which the error is judged

double root_mean_square(std::span<const double> a, std::span<const double> b) {
  std::vector<double> squares(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) squares[i] = (a[i] + b[i]) * (a[i] + b[i]);
  return std::sqrt(ordered_sum(squares) / static_cast<double>(squares.size()));
}

void check(const Scene& scene, const AccuracyRequest& request) {
  if (!(request.relative > 0 && std::isfinite(request.relative)))
    throw InputError({fmt::format("accuracy of {}", request.relative), "accuracy",
                      "it is the relative error allowed, above 0", "accuracy = 0.01"});
  if (request.most_photons < sets * first_photons)
    throw InputError({fmt::format("at most {} photons", request.most_photons), "model.most_photons",
                      fmt::format("the first look takes {}", sets * first_photons), "allow a million"});
  if (request.model.rung)
    if (const auto objection = rung_objection(*request.model.rung, scene, request.model))
      throw InputError({fmt::format("rung {} cannot light this scene", name(*request.model.rung)),
                        "model.rung", *objection, "model.rung = \"auto\""});
}

/// Every k-th sample, so that no more than most_probes are left.
std::vector<FieldSample> probes_of(std::span<const FieldSample> samples) {
  const std::size_t stride = (samples.size() + most_probes - 1) / most_probes;
  std::vector<FieldSample> probes;
  for (std::size_t i = 0; i < samples.size(); i += stride) probes.push_back(samples[i]);
  return probes;
}

/// As few leading binary digits as keep a count within an eighth: low-discrepancy points are most even there.
std::uint64_t round_up(double count) {
  const auto whole = static_cast<std::uint64_t>(std::ceil(count));
  const int drop = std::max(0, static_cast<int>(std::bit_width(whole)) - 4);
  return ((whole + (std::uint64_t{1} << drop) - 1) >> drop) << drop;
}

/// Works by photons: stage after stage.
class PhotonStages {
 public:
  PhotonStages(const Scene& scene, std::span<const FieldSample> samples, const AccuracyRequest& request,
               Rung rung, std::vector<double> direct)
      : scene_(scene), samples_(samples), request_(request), probes_(probes_of(samples)) {
    field_.rung = rung;
    field_.direct = std::move(direct);
    field_.sets = sets;
    const std::size_t stride = (samples.size() + most_probes - 1) / most_probes;
    for (std::size_t i = 0; i < samples.size(); i += stride) probe_direct_.push_back(field_.direct[i]);
  }

  AccurateField run() {
    std::uint64_t photons = first_photons;
    for (;;) {
      stage(photons);
      if (field_.proven || stopped_) break;
      const std::uint64_t next = forecast(photons);
      if (next == 0) break;
      photons = next;
    }
    finish(photons);
    return std::move(field_);
  }

 private:
  LadderOptions ladder_options(std::uint64_t photons) const {
    LadderOptions options;
    options.rung = field_.rung;
    options.photons = request_.photons;
    options.photons.photons = photons;
    options.photons.stream += sets * field_.stages.size();
    options.sets = sets;
    return options;
  }

  void stage(std::uint64_t photons) {
    options_ = ladder_options(photons);
    constexpr double photons_of_the_narrowest = 4;
    const double widest = widest_kernel_radius_mm(scene_.near_field);
    const double narrowest = 2 * widest * std::sqrt(photons_of_the_narrowest / static_cast<double>(photons));
    // More photons want a narrower kernel than the stage before; wider ones show how bias falls.
    constexpr double wider = 2.8284271247461903;  // three levels
    options_.widest_radius_mm = field_.stages.empty() ? widest : std::min(widest, wider * choice_radius_mm_);
    const double steps = std::ceil(2 * std::log2(options_.widest_radius_mm / narrowest));
    options_.levels = static_cast<std::size_t>(std::clamp(steps, 4.0, field_.stages.empty() ? 12.0 : 9.0));
    ladder_ = look_with_ladder(scene_, probes_, options_);
    choice_ = best_choice(ladder_);
    choice_radius_mm_ = ladder_.levels[choice_.level].kernel_radius_mm;
    field_.spent_photons += sets * photons;
    judge(photons);
  }

  void judge(std::uint64_t photons) {
    const SetFields& fields = fields_of(ladder_.levels[choice_.level], choice_.order);
    const double rms = root_mean_square(mean_of(fields), probe_direct_);
    double error95 = choice_.error95;
    if (ladder_.counts.stored == 0) {
      // Light that not one of n photons showed has less than three n-ths of the power (95 %).
      const double unseen_w = 3 * ladder_.energy.emitted_w / static_cast<double>(sets * photons);
      error95 = unseen_w / scene_.near_field.area_mm2();
    }
    const double scale = rms > 0 ? 1 / rms : HUGE_VAL;
    field_.noise_rel = choice_.noise > 0 ? choice_.noise * scale : 0;
    field_.bias_rel = choice_.bias > 0 ? choice_.bias * scale : 0;
    field_.error95_rel = error95 > 0 ? error95 * scale : 0;
    field_.stages.push_back({sets * photons, field_.error95_rel});
    field_.proven = field_.error95_rel <= request_.relative;
    stopped_ = request_.watch && !request_.watch(field_.spent_photons, field_.error95_rel);
  }

  /// Photons of a set that should prove the accuracy; 0 when no more may be spent.
  std::uint64_t forecast(std::uint64_t photons) const {
    const auto& stages = field_.stages;
    // Before it has been seen: of random photons in kernels of their own choice, and of even ones.
    double slope = request_.photons.sampler == Sampler::sobol ? 0.7 : 0.4;
    if (stages.size() > 1) {
      const AccuracyStage &a = stages[stages.size() - 2], &b = stages.back();
      const double gained = std::log(a.error95_rel / b.error95_rel);
      const double spent = std::log(static_cast<double>(b.photons) / static_cast<double>(a.photons));
      // The error falls like a power between 1/4 (jumps) and 1 (the evenest points).
      if (std::isfinite(gained)) slope = std::clamp(gained / spent, 0.25, 1.0);
    }
    constexpr double headroom =
        0.9;  // stages whose error is expected below this share of the accuracy rarely fail
    const double shortfall = stages.back().error95_rel / (headroom * request_.relative);
    const double growth =
        std::isfinite(shortfall) ? std::clamp(std::pow(shortfall, 1 / slope), 1.3, 16.0) : 16.0;
    const std::uint64_t next = round_up(growth * static_cast<double>(photons));
    const std::uint64_t left = request_.most_photons - std::min(request_.most_photons, field_.spent_photons);
    if (sets * next <= left && next <= most_photons) return next;
    const std::uint64_t last = std::min(left / sets, most_photons);
    return last > 2 * photons ? last : 0;
  }

  void finish(std::uint64_t photons) {
    field_.photons = photons;
    field_.kernel_radius_mm = choice_radius_mm_;
    field_.order = choice_.order;
    field_.energy = ladder_.energy;
    field_.counts = ladder_.counts;
    BandwidthLadder all;
    const LadderLevel* level = &ladder_.levels[choice_.level];
    if (probes_.size() < samples_.size()) {  // the same photons again, at every sample
      options_.widest_radius_mm = choice_radius_mm_;
      options_.levels = 1;
      all = look_with_ladder(scene_, samples_, options_);
      level = &all.levels.front();
      field_.spent_photons += sets * photons;
    }
    field_.by_set = fields_of(*level, choice_.order);
    field_.reflected = mean_of(field_.by_set);
    field_.noise = deviation_of_mean(field_.by_set);
    for (double& value : field_.reflected) value = std::max(0.0, value);
    field_.sentence = field_.proven ? proof() : shortcoming();
  }

  std::string proof() const {
    return fmt::format(
        "proven: relative error at most {:.2g} with 95 % probability (asked {:g}), rung {}, {} "
        "photons spent",
        field_.error95_rel, request_.relative, name(field_.rung), field_.spent_photons);
  }

  std::string shortcoming() const {
    if (stopped_)
      return fmt::format("interrupted at a relative error of {:.2g} (asked {:g})", field_.error95_rel,
                         request_.relative);
    return fmt::format(
        "not proven: after {} photons the relative error may still be {:.2g} (asked {:g}); allow "
        "more with model.most_photons, or ask for less",
        field_.spent_photons, field_.error95_rel, request_.relative);
  }

  const Scene& scene_;
  std::span<const FieldSample> samples_;
  const AccuracyRequest& request_;
  std::vector<FieldSample> probes_;
  std::vector<double> probe_direct_;
  AccurateField field_;
  LadderOptions options_;
  BandwidthLadder ladder_;
  LadderChoice choice_;
  double choice_radius_mm_ = 0;
  bool stopped_ = false;
};

AccurateField by_tubes(const Scene& scene, std::span<const FieldSample> samples,
                       const AccuracyRequest& request, std::vector<double> direct) {
  AccurateField field;
  field.rung = Rung::tubes;
  TubesOptions options;
  options.most_interactions = request.photons.most_interactions;
  // The field is at least the direct light, so that a share of it is a share of the field allowed too.
  constexpr double share = 0.1;
  const std::vector<double> dark(direct.size(), 0.0);
  options.pointwise_tolerance_w_per_mm2 = share * request.relative * root_mean_square(direct, dark);
  TubesField tubes = tubes_field(scene, samples, options);
  field.rays = tubes.rays;
  field.reflected = std::move(tubes.irradiance);
  field.direct = std::move(direct);
  field.by_set = {field.reflected};
  field.sets = 1;
  field.noise.assign(field.reflected.size(), 0.0);
  const double rms = root_mean_square(field.reflected, field.direct);
  // In a dark field there is nothing to be relative to, and nothing to be wrong about.
  field.error95_rel = tubes.error_w_per_mm2 > 0 ? tubes.error_w_per_mm2 / rms : 0;
  field.bias_rel = field.error95_rel;
  field.proven = std::isfinite(rms) && field.error95_rel <= request.relative;
  field.sentence = field.proven
                       ? fmt::format(
                             "proven: relative error at most {:.2g} (asked {:g}), rung tubes, {} rays, no "
                             "random numbers",
                             field.error95_rel, request.relative, field.rays)
                       : fmt::format("not proven: {} ray tubes leave a relative error of {:.2g} (asked {:g})",
                                     field.rays, field.error95_rel, request.relative);
  return field;
}

}  // namespace

AccurateField reach_accuracy(const Scene& scene, std::span<const FieldSample> samples,
                             const AccuracyRequest& request) {
  check(scene, request);
  std::vector<double> direct = direct_field(scene, samples);
  const auto taken = [&](Rung rung) {
    if (request.model.rung) return *request.model.rung == rung;
    return !rung_objection(rung, scene, request.model);
  };
  if (taken(Rung::tubes) && !(request.fresh_photons_only && !request.model.rung)) {
    AccurateField field = by_tubes(scene, samples, request, direct);
    // Cavities with very many paths need more tubes than photons are worth.
    if (field.proven || request.model.rung == Rung::tubes) return field;
  }
  const Rung rung = taken(Rung::rings) ? Rung::rings : Rung::photons;
  return PhotonStages(scene, samples, request, rung, std::move(direct)).run();
}

}  // namespace catoptric::sim
