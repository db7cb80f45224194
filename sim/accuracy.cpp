#include "sim/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/byte_record.h"
#include "base/errors.h"
#include "base/ordered_sum.h"
#include "sim/bandwidth_ladder.h"
#include "sim/field_breaks.h"
#include "sim/ladder_error.h"
#include "sim/probes.h"
#include "sim/simulation.h"
#include "sim/tubes.h"

namespace catoptric::sim {
namespace {

constexpr std::uint64_t first_photons = 512;  ///< of a set: enough for a forecast
constexpr std::size_t probes_smooth = 128;    ///< samples by which a stage is judged
constexpr std::size_t probes_broken = 512;    ///< where what counts may lie along a line
constexpr std::size_t first_levels = 6;       ///< of bandwidths, down to some four photons in a kernel
constexpr std::size_t fewest_levels = 7;      ///< of later stages
constexpr std::size_t narrower_levels = 4;    ///< than the bandwidth expected to be best

/// Of the sum of two fields, by samples that stand for shares.
double root_mean_square(std::span<const double> a, std::span<const double> b,
                        std::span<const double> shares) {
  std::vector<double> squares(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) squares[i] = shares[i] * (a[i] + b[i]) * (a[i] + b[i]);
  return std::sqrt(ordered_sum(squares));
}

double root_mean_square(std::span<const double> a, std::span<const double> b) {
  return root_mean_square(a, b, std::vector<double>(a.size(), 1 / static_cast<double>(a.size())));
}

void check(const Scene& scene, const AccuracyRequest& request) {
  if (!(request.relative > 0 && std::isfinite(request.relative)))
    throw InputError({fmt::format("accuracy of {}", request.relative), "accuracy",
                      "it is the relative error allowed, above 0", "accuracy = 0.01"});
  if (request.most_photons < sets_of_photons * first_photons)
    throw InputError({fmt::format("at most {} photons", request.most_photons), "model.most_photons",
                      fmt::format("the first look takes {}", sets_of_photons * first_photons),
                      "allow a million"});
  if (request.model.rung)
    if (const auto objection = rung_objection(*request.model.rung, scene, request.model))
      throw InputError({fmt::format("rung {} cannot light this scene", name(*request.model.rung)),
                        "model.rung", *objection, "model.rung = \"auto\""});
}

/// The list's elements that were picked.
template <typename Element>
std::vector<Element> picked(std::span<const Element> list, const Probes& probes) {
  std::vector<Element> some;
  some.reserve(probes.picks.size());
  for (const std::size_t i : probes.picks) some.push_back(list[i]);
  return some;
}

/// The power of two nearest above. Sobol points are most even there: 4096 are as good as 7000.
std::uint64_t round_up(double count) { return std::bit_ceil(static_cast<std::uint64_t>(std::ceil(count))); }

/// What a stage does.
struct StagePlan {
  std::uint64_t photons = first_photons;  ///< of a set
  std::size_t levels = first_levels;
};

/// Works by photons: stage after stage.
class PhotonStages {
 public:
  PhotonStages(const Scene& scene, std::span<const FieldSample> samples, const AccuracyRequest& request,
               Rung rung, std::vector<double> direct)
      : scene_(scene),
        samples_(samples),
        request_(request),
        photon_sets_(scene, rung),
        picker_(photon_sets_.cells_of(samples)) {
    field_.rung = rung;
    field_.direct = std::move(direct);
    field_.sets = sets_of_photons;
    KernelRange range = kernel_range(scene, rung);
    widest_radius_mm_ = range.widest_radius_mm;
    field_.breaks = std::move(range.breaks);
  }

  AccurateField run() {
    StagePlan plan;
    for (;;) {
      stage(plan);
      if (field_.proven || stopped_) break;
      const StagePlan next = next_plan(plan);
      if (next.photons == 0) break;
      plan = next;
    }
    finish(plan.photons);
    return std::move(field_);
  }

 private:
  void stage(const StagePlan& plan) {
    PhotonOptions photons = request_.photons;
    photons.photons = plan.photons;
    photons.stream += sets_of_photons * field_.stages.size();
    photon_sets_.fly(photons, sets_of_photons, widest_radius_mm_);
    field_.spent_photons += sets_of_photons * plan.photons;
    judge(plan);
    field_.stages.push_back({sets_of_photons * plan.photons, field_.error95_rel});
    stopped_ = !goes_on();
  }

  /// As the one who watches rank 0 says.
  bool goes_on() const {
    if (!request_.watch) return true;
    Ranks& ranks = request_.photons.ranks ? *request_.photons.ranks : lone_process();
    return ranks
               .from_first([&] {
                 return ByteWriter().put(request_.watch(field_.spent_photons, field_.error95_rel)).take();
               })
               .front() != 0;
  }

  const LadderLevel& chosen() const { return ladder_[choice_.level]; }

  /// What the photons of this stage prove, by samples picked anew: half of them where the light falls.
  void judge(const StagePlan& plan) {
    const Probes probes =
        picker_.pick(photon_sets_.light_by_cell(), field_.breaks ? probes_broken : probes_smooth);
    ladder_ = photon_sets_.look(picked(samples_, probes), widest_radius_mm_, plan.levels);
    const double emitted = static_cast<double>(sets_of_photons * plan.photons);
    const double photon_w = photon_sets_.energy().emitted_w / emitted * surviving_share(scene_.mirror);
    summary_ = summary_of(ladder_, !field_.breaks, probes.shares, {photon_w, scene_.near_field.area_mm2()});
    choice_ = best_choice(summary_);
    rms_ = root_mean_square(mean_of(fields_of(chosen(), choice_.order)),
                            picked(std::span<const double>(field_.direct), probes), probes.shares);
    const double scale = rms_ > 0 ? 1 / rms_ : HUGE_VAL;
    field_.noise_rel = choice_.noise > 0 ? choice_.noise * scale : 0;
    field_.bias_rel = choice_.bias > 0 ? choice_.bias * scale : 0;
    field_.error95_rel = choice_.error95 > 0 ? choice_.error95 * scale : 0;
    field_.proven = field_.error95_rel <= request_.relative;
  }

  /// By how much the photons must grow to prove the accuracy, as far as this stage can tell.
  double growth_needed() const {
    constexpr double step = 2, most = 131072;
    // Stages whose error is expected below this share of the accuracy rarely fail.
    constexpr double headroom = 0.8;
    if (!(rms_ > 0)) return most;
    double growth = step;
    while (growth < most &&
           best_choice(expected_with(summary_, growth)).error95 > headroom * request_.relative * rms_)
      growth *= step;
    return growth;
  }

  /// The next stage; without photons when no more may be spent.
  StagePlan next_plan(const StagePlan& plan) const {
    // What is far away is not foreseen well: a stage of an eighth of the cost on the way there pays.
    constexpr double far = 16, on_the_way = 8, farthest = 64;
    double growth = growth_needed();
    if (growth > far) growth = std::min(growth / on_the_way, farthest);
    StagePlan next;
    next.photons = round_up(growth * static_cast<double>(plan.photons));
    const std::uint64_t left = request_.most_photons - std::min(request_.most_photons, field_.spent_photons);
    if (sets_of_photons * next.photons > left || next.photons > most_photons) {
      next.photons = std::bit_floor(std::min(left / sets_of_photons, most_photons));
      if (next.photons < 2 * plan.photons) return {0, 0};
    }
    const double times = static_cast<double>(next.photons) / static_cast<double>(plan.photons);
    // All wider ones too: they show how bias falls.
    next.levels =
        std::max(fewest_levels, best_choice(expected_with(summary_, times)).level + narrower_levels);
    return next;
  }

  void finish(std::uint64_t photons) {
    field_.photons = photons;
    field_.kernel_radius_mm = chosen().kernel_radius_mm;
    field_.order = choice_.order;
    field_.energy = photon_sets_.energy();
    field_.counts = photon_sets_.counts();
    field_.by_set = photon_sets_.fields(samples_, chosen().kernel_radius_mm, choice_.order);
    field_.reflected = mean_of(field_.by_set);
    field_.noise = deviation_of_mean(field_.by_set);
    for (double& value : field_.reflected) value = std::max(0.0, value);
    field_.sentence = field_.proven ? proof() : shortcoming();
  }

  std::string proof() const {
    return fmt::format(
        "proven: relative error at most {:.2g} with 95 % probability (asked {:g}), rung {}, {} "
        "photons spent{}",
        field_.error95_rel, request_.relative, name(field_.rung), field_.spent_photons, why_dear());
  }

  std::string why_dear() const {
    return field_.breaks ? fmt::format("; bias counted as at a jump, since {}", *field_.breaks) : "";
  }

  std::string shortcoming() const {
    if (stopped_)
      return fmt::format("interrupted at a relative error of {:.2g} (asked {:g})", field_.error95_rel,
                         request_.relative);
    if (!std::isfinite(field_.error95_rel))
      return fmt::format(
          "not proven: of {} photons none landed beside a sample; allow more with model.most_photons, or "
          "look "
          "where the light falls",
          field_.spent_photons);
    return fmt::format(
        "not proven: after {} photons the relative error may still be {:.2g} (asked {:g}); allow "
        "more with model.most_photons, or ask for less{}",
        field_.spent_photons, field_.error95_rel, request_.relative, why_dear());
  }

  const Scene& scene_;
  std::span<const FieldSample> samples_;
  const AccuracyRequest& request_;
  PhotonSets photon_sets_;
  ProbePicker picker_;
  double widest_radius_mm_ = 0;
  AccurateField field_;
  BandwidthLadder ladder_;
  LadderSummary summary_;
  LadderChoice choice_;
  double rms_ = 0;  ///< of the field at the probes, W/mm^2
  bool stopped_ = false;
};

AccurateField by_tubes(const Scene& scene, std::span<const FieldSample> samples,
                       const AccuracyRequest& request, std::vector<double> direct) {
  AccurateField field;
  field.rung = Rung::tubes;
  TubesOptions options;
  options.most_interactions = request.photons.most_interactions;
  options.most_meetings = 2'000'000;  // some seconds at worst: in cavities photons are worth more
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

KernelRange kernel_range(const Scene& scene, Rung rung) {
  constexpr double least_share = 0.4;  // narrower kernels alone would show bias too late
  const double widest_mm = widest_kernel_radius_mm(scene.near_field);
  SmoothReach reach = find_breaks(
      scene, rung == Rung::rings ? UnknownBreaks::folds : UnknownBreaks::edges_and_folds, widest_mm);
  if (reach.clear_mm < least_share * widest_mm) return {widest_mm, std::move(reach.nearest)};
  return {std::min(widest_mm, reach.clear_mm), {}};
}

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
