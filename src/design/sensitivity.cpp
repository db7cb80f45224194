#include "design/sensitivity.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>

#include "base/byte_record.h"
#include "design/evaluator.h"
#include "design/field_change.h"
#include "design/shared_work.h"

namespace catoptric::design {
namespace {

using Index = std::size_t;

/// A tolerance costs what is allowed to this, or to the noise of photons.
constexpr double sought_rel = 0.005;
constexpr int most_trials = 30;
/// Steps of the differences over the tolerance: tubes have no noise, so that small ones are good.
constexpr double step_by_tubes = 0.02, step_by_photons = 0.5;

/// Finds the deviation, to the side of `sign`, whose change is the allowed one: the change grows about in
/// proportion, so that each trial is the last one times allowed over found, within what is known to be too
/// little and too much.
class ToleranceSearch {
 public:
  ToleranceSearch(FieldChanger& changer, const Deviation& deviation, sim::Rung rung, double allowed_rel,
                  const RunControl& control)
      : changer_(changer), deviation_(deviation), rung_(rung), allowed_rel_(allowed_rel), control_(control) {}

  std::optional<Tolerated> operator()(double sign) const {
    const double most = sign > 0 ? deviation_.greatest : -deviation_.least;
    if (!(most > 0)) return std::nullopt;
    double enough = 0, too_much = most * (1 + 1e-12), trial = std::min(deviation_.first_guess, most);
    std::optional<Tolerated> nearest;
    for (int i = 0; i < most_trials; ++i) {
      if (control_.stopped()) throw Interrupted();
      const auto changes = changer_.changes(deviation_, sign * trial, rung_);
      if (!changes) {
        too_much = trial;
        trial = 0.5 * (enough + too_much);
        continue;
      }
      const Tolerated found{sign * trial, changer_.measure(*changes)};
      const double off = std::abs(found.change.value_rel - allowed_rel_);
      if (!nearest || off < std::abs(nearest->change.value_rel - allowed_rel_)) nearest = found;
      if (off <= std::max(sought_rel * allowed_rel_, 0.5 * found.change.noise_rel)) return found;
      if (found.change.value_rel < allowed_rel_) {
        if (trial >= most) return std::nullopt;
        enough = std::max(enough, trial);
      } else {
        too_much = std::min(too_much, trial);
      }
      trial = next(trial, found.change.value_rel, enough, too_much, most);
    }
    return nearest;
  }

 private:
  double next(double trial, double found_rel, double enough, double too_much, double most) const {
    const double factor = found_rel > 0 ? std::clamp(allowed_rel_ / found_rel, 0.1, 10.0) : 10.0;
    const double proportional = std::min(trial * factor, most);
    const bool between = proportional > enough && proportional < too_much;
    return between ? proportional : 0.5 * (enough + std::min(too_much, most));
  }

  FieldChanger& changer_;
  const Deviation& deviation_;
  sim::Rung rung_;
  double allowed_rel_;
  const RunControl& control_;
};

/// (E(p + h) - E(p - h)) / (2 h), to one side where the other has no scene.
std::optional<Changes> derivative(FieldChanger& changer, const Deviation& deviation, sim::Rung rung,
                                  double step) {
  const auto up = step <= deviation.greatest ? changer.changes(deviation, step, rung) : std::nullopt;
  const auto down = -step >= deviation.least ? changer.changes(deviation, -step, rung) : std::nullopt;
  if (!up && !down) return std::nullopt;
  Changes slope = up ? *up : *down;
  const double width = up && down ? 2 * step : up ? step : -step;
  for (Index r = 0; r < slope.w_per_mm2.size(); ++r)
    for (Index i = 0; i < slope.w_per_mm2[r].size(); ++i) {
      if (up && down) slope.w_per_mm2[r][i] -= down->w_per_mm2[r][i];
      slope.w_per_mm2[r][i] /= width;
    }
  return slope;
}

ParameterSensitivity measure(FieldChanger& changer, const Scene& scene, const Profile& profile,
                             const Deviation& deviation, const RunControl& control) {
  // To the side that makes sense: a mirror that reflects all cannot reflect more.
  const auto small = deviation.at(deviation.first_guess <= deviation.greatest ? deviation.first_guess
                                                                              : -deviation.first_guess);
  const sim::Rung rung =
      small ? make_plan(small->scene, small->profile).rung : make_plan(scene, profile).rung;
  const std::uint64_t before = changer.photons();
  ParameterSensitivity result{.deviation = deviation, .rung = rung, .replicates = changer.replicates(rung)};
  const ToleranceSearch search(changer, deviation, rung, scene.sensitivity.allowed_rel, control);
  result.plus = search(1);
  result.minus = search(-1);
  const double share = rung == sim::Rung::tubes ? step_by_tubes : step_by_photons;
  result.step = share * result.tolerance().value_or(deviation.first_guess / share);
  const auto slope = derivative(changer, deviation, rung, result.step);
  result.photons = changer.photons() - before;
  if (!slope) return result;
  result.change_per_unit = changer.measure(*slope);
  result.derivative_w_per_mm2 = changer.along_cut(*slope);
  result.derivative_noise_w_per_mm2 = changer.noise_along_cut(*slope);
  if (auto wide = derivative(changer, deviation, rung, 2 * result.step)) {
    for (Index r = 0; r < wide->w_per_mm2.size(); ++r)
      for (Index i = 0; i < wide->w_per_mm2[r].size(); ++i) wide->w_per_mm2[r][i] -= slope->w_per_mm2[r][i];
    // What changes nothing by any step is linear.
    const double bend = changer.measure(*wide).value_rel, change = result.change_per_unit.value_rel;
    if (bend > 0) result.nonlinearity_rel = change > 0 ? bend / change : HUGE_VAL;
  }
  result.photons = changer.photons() - before;
  return result;
}

Bytes as_bytes(const ParameterSensitivity& each) {
  return ByteWriter()
      .put(each.rung)
      .put(each.replicates)
      .put(each.step)
      .put(each.change_per_unit)
      .put(each.nonlinearity_rel)
      .put(each.derivative_w_per_mm2)
      .put(each.derivative_noise_w_per_mm2)
      .put(each.minus)
      .put(each.plus)
      .put(each.photons)
      .take();
}

ParameterSensitivity parameter_sensitivity_of(const Bytes& bytes, const Deviation& deviation) {
  ParameterSensitivity each{.deviation = deviation, .rung = {}};
  ByteReader(bytes)
      .get(each.rung)
      .get(each.replicates)
      .get(each.step)
      .get(each.change_per_unit)
      .get(each.nonlinearity_rel)
      .get(each.derivative_w_per_mm2)
      .get(each.derivative_noise_w_per_mm2)
      .get(each.minus)
      .get(each.plus)
      .get(each.photons);
  return each;
}

/// All that flew: for each deviation, and once for the scene itself by every rung that was asked.
std::uint64_t photons_of_all(const FieldChanger& changer, sim::Rung own,
                             const std::vector<ParameterSensitivity>& parameters) {
  std::set<sim::Rung> rungs{own};
  std::uint64_t photons = 0;
  for (const ParameterSensitivity& each : parameters) {
    if (each.photons > 0) rungs.insert(each.rung);
    photons += each.photons;
  }
  for (const sim::Rung rung : rungs) photons += changer.photons_of_a_scene(rung);
  return photons;
}

}  // namespace

std::optional<double> ParameterSensitivity::tolerance() const {
  if (!minus && !plus) return std::nullopt;
  return std::min(minus ? -minus->deviation : HUGE_VAL, plus ? plus->deviation : HUGE_VAL);
}

std::size_t Sensitivity::budgeted() const {
  return static_cast<Index>(std::count_if(parameters.begin(), parameters.end(),
                                          [](const auto& each) { return each.tolerance().has_value(); }));
}

Sensitivity run_sensitivity(const Scene& written, const RunControl& control) {
  const auto begin = std::chrono::steady_clock::now();
  Candidate start = start_candidate(written);
  Scene scene = written;
  scene.source = start.source;
  scene.mirror = start.mirror;
  Sensitivity result{std::move(start.profile), {}, {}, 0, scene.sensitivity.allowed_rel, {}, 0, 0};
  FieldChanger changer(scene, result.profile);
  const std::vector<Deviation> list = deviations(scene, result.profile);
  const auto tell = [&](const char* last) {
    control.tell({"sensitivity",
                  static_cast<double>(result.parameters.size()) / static_cast<double>(list.size()),
                  std::numeric_limits<double>::quiet_NaN(), 0, last});
  };
  tell("");
  const auto of_deviation = [&](Index i) {
    return as_bytes(measure(changer, scene, result.profile, list[i], control));
  };
  const auto take = [&](Index i, const Bytes& bytes) {
    result.parameters.push_back(parameter_sensitivity_of(bytes, list[i]));
    tell(list[i].name.c_str());
  };
  ranks_of(control).join(list.size(), of_deviation, take, [] { return Bytes(); });
  result.radii_mm = changer.radii_mm();
  const sim::Rung own = make_plan(scene, result.profile).rung;
  result.field_w_per_mm2 = changer.field_along_cut(own);
  result.field_rms_w_per_mm2 = changer.field_rms_w_per_mm2();
  result.photons = photons_of_all(changer, own, result.parameters);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace catoptric::design
