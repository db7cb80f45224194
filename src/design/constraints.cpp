#include "design/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/profile_hull.h"
#include "design/profile_measures.h"

namespace catoptric::design {
namespace {

constexpr double right_angle_rad = 0.5 * pi;
/// Of the scale: what the conversion of units and a few roundings leave of a limit that is just kept.
constexpr double rounding = 1e-12;

class States {
 public:
  States(const Profile& profile) : diagonal_mm_(profile.diagonal_mm()) {}

  void at_most(const char* name, std::optional<double> limit, double value, bool certified) {
    if (limit) add({name, Dimension::length, false, value, *limit, value - *limit, scale(*limit), certified});
  }
  void at_least(const char* name, std::optional<double> limit, double value, bool certified) {
    if (limit) add({name, Dimension::length, true, value, *limit, *limit - value, scale(*limit), certified});
  }
  void add(ConstraintState state) {
    if (!(state.violation > rounding * state.scale))
      state.violation = std::isnan(state.violation) ? HUGE_VAL : 0;
    list_.push_back(std::move(state));
  }
  std::vector<ConstraintState> list_;

 private:
  double scale(double limit_mm) const { return limit_mm != 0 ? std::abs(limit_mm) : diagonal_mm_; }
  double diagonal_mm_;
};

double least_radius_mm(const Profile& profile) {
  double least = HUGE_VAL;
  for (const RationalSpan& span : profile.spans()) least = std::min(least, range_of_r(span).least);
  return least;
}

void add_envelope(const Constraints& constraints, const Profile& profile, States& list) {
  list.at_most("envelope_radius", constraints.envelope_radius_mm, profile.r_max_mm(), true);
  if (!constraints.envelope_low_mm) return;
  const double low = *constraints.envelope_low_mm, high = *constraints.envelope_high_mm;
  list.add({"envelope_z (low end)", Dimension::length, true, profile.z_min_mm(), low,
            low - profile.z_min_mm(), high - low, true});
  list.add({"envelope_z (high end)", Dimension::length, false, profile.z_max_mm(), high,
            profile.z_max_mm() - high, high - low, true});
}

void add_folds(const Constraints::Landing& landing, const Profile& profile, States& list) {
  const Loops found = loops(profile);
  list.add({"no_folds (curve crosses itself)", Dimension::share, false, found.share, 0, found.share, 1,
            found.certified});
  const double backward = backward_share(profile, landing.source_z_mm, landing.field_z_mm, landing.size_mm);
  list.add({"no_folds (rays land backwards)", Dimension::share, false, backward, 0, backward, 1, false});
}

}  // namespace

std::vector<ConstraintState> states(const Constraints& constraints, const Profile& profile) {
  States list(profile);
  const double rim_mm = profile.at(profile.last_parameter()).r_mm;
  list.at_least("rim_radius_min", constraints.rim_radius_min_mm, rim_mm, true);
  list.at_most("rim_radius_max", constraints.rim_radius_max_mm, rim_mm, true);
  list.at_most("height_max", constraints.height_max_mm, profile.z_max_mm() - profile.z_min_mm(), true);
  if (constraints.opening_min_mm)
    list.at_least("opening_min", constraints.opening_min_mm, least_radius_mm(profile), true);
  add_envelope(constraints, profile, list);
  if (constraints.curvature_radius_min_mm)
    list.at_least("curvature_radius_min", constraints.curvature_radius_min_mm,
                  least_curvature_radius_mm(profile), false);
  if (const auto limit = constraints.draft_angle_min_rad) {
    const double draft = least_draft_rad(profile);
    list.add(
        {"draft_angle_min", Dimension::angle, true, draft, *limit, *limit - draft, right_angle_rad, false});
  }
  if (constraints.wall_mm)
    list.at_least("wall", constraints.wall_mm, greatest_wall_mm(profile, constraints.wall_outside), false);
  if (constraints.no_folds) add_folds(*constraints.no_folds, profile, list);
  return std::move(list.list_);
}

double violation(std::span<const ConstraintState> states) {
  double sum = 0;
  for (const ConstraintState& state : states) sum += state.violation / state.scale;
  return sum;
}

double violation(const Constraints& constraints, const Profile& profile) {
  return violation(states(constraints, profile));
}

double shown(const ConstraintState& state, double number, LengthUnit unit) {
  switch (state.dimension) {
    case Dimension::length:
      return number / millimetres_per(unit);
    case Dimension::angle:
      return number * 180 / pi;
    case Dimension::share:
      break;
  }
  return 100 * number;
}

std::string unit_of(const ConstraintState& state, LengthUnit unit) {
  if (state.dimension == Dimension::length) return std::string(symbol(unit));
  return state.dimension == Dimension::angle ? "deg" : "%";
}

std::string sentence(std::span<const ConstraintState> states, LengthUnit unit) {
  if (states.empty()) return {};
  std::string broken;
  for (const ConstraintState& state : states) {
    if (state.violation == 0) continue;
    broken += fmt::format("{}{} is {:.6g} {}, {} {:.6g} is allowed ({:.3g} {} {})",
                          broken.empty() ? "" : "; ", state.name, shown(state, state.value, unit),
                          unit_of(state, unit), state.at_least ? "at least" : "at most",
                          shown(state, state.limit, unit), shown(state, state.violation, unit),
                          unit_of(state, unit), state.at_least ? "too little" : "too much");
  }
  return broken.empty() ? "All constraints are met." : "Constraints that are not satisfied: " + broken + ".";
}

}  // namespace catoptric::design
