#include "cad/opening.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/float_traps.h"
#include "base/planar_roots.h"
#include "base/tolerance.h"
#include "cad/refine.h"

namespace catoptric::cad {
namespace {

/// Parameters inside the curve at which it has that radius; a touch counts as one.
std::vector<double> crossings(const Profile& profile, double radius_mm, double within_mm) {
  std::vector<double> found;
  for (const RationalSpan& span : profile.spans()) {
    planar::SignedForm form{{}, {}, 0, 1, true, true};
    for (std::size_t i = 0; i < span.w.size(); ++i) {
      form.w[i] = span.w[i];
      form.a[i] = span.rw[i] - radius_mm * span.w[i];
    }
    const auto add = [&](double s) {
      const double u = span.first + s * (span.last - span.first);
      const double apart = Tolerance::for_scale(radius_mm).parameter * (span.last - span.first);
      const bool again = !found.empty() && u - found.back() <= apart;  // a knot on the edge: once a span
      if (u - profile.first_parameter() > apart && profile.last_parameter() - u > apart && !again)
        found.push_back(u);
    };
    std::vector<double> in_span;
    const auto collect = [&](double s) { in_span.push_back(s); };
    planar::RootFinder(profile.degree(), within_mm, collect).find(form);
    std::sort(in_span.begin(), in_span.end());
    for (const double s : in_span) add(s);
  }
  return found;
}

[[noreturn]] void refuse_opening(double radius_mm, std::string why, std::string hint) {
  throw InputError({fmt::format("an opening of radius {} mm cannot be cut", radius_mm), "", std::move(why),
                    std::move(hint)});
}

/// The curve before or after `u`, where a control point comes to lie on it.
Profile part(const Profile& profile, double u, bool after, double radius_mm) {
  const auto there = std::count(profile.knots().begin(), profile.knots().end(), u);
  const std::vector<double> knots(static_cast<std::size_t>(std::max(0L, profile.degree() - there)), u);
  const Profile cut = with_knots(profile, knots);
  const auto first = std::find(cut.knots().begin(), cut.knots().end(), u);
  const auto place =
      first - cut.knots().begin();  // of the knot; the control point before it lies on the curve
  std::vector<double> kept;
  std::vector<ControlPoint> points;
  if (after) {
    kept.push_back(u);
    kept.insert(kept.end(), first, cut.knots().end());
    points.assign(cut.points().begin() + place - 1, cut.points().end());
    points.front().r_mm = radius_mm;
  } else {
    kept.assign(cut.knots().begin(), first + cut.degree());
    kept.push_back(u);
    points.assign(cut.points().begin(), cut.points().begin() + place);
    points.back().r_mm = radius_mm;
  }
  return Profile(cut.degree(), std::move(kept), std::move(points));
}

}  // namespace

Profile with_opening(const Profile& profile, double radius_mm) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  const double within_mm = Tolerance::for_scale(profile.diagonal_mm()).length_mm;
  if (!(radius_mm > 0 && radius_mm < profile.r_max_mm() - within_mm))
    refuse_opening(radius_mm,
                   fmt::format("it lies between 0 and the mirror's radius, {} mm", profile.r_max_mm()),
                   "a smaller opening");
  const std::vector<double> met = crossings(profile, radius_mm, within_mm);
  const bool begins_inside = profile.at(profile.first_parameter()).r_mm < radius_mm - within_mm;
  const bool ends_inside = profile.at(profile.last_parameter()).r_mm < radius_mm - within_mm;
  if (!begins_inside && !ends_inside && met.empty()) return profile;
  if (met.size() != 1 || begins_inside == ends_inside)
    refuse_opening(radius_mm,
                   fmt::format("the generatrix meets its edge {} times, so that more than one piece is left",
                               met.size()),
                   "an opening whose edge the mirror meets once");
  return part(profile, met.front(), begins_inside, radius_mm);
}

}  // namespace catoptric::cad
