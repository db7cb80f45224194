#include "cad/refine.h"

#include <fmt/format.h>

#include <Geom_BSplineCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/float_traps.h"
#include "cad/detail/occt_curve.h"
#include "cad/detail/occt_guard.h"

namespace catoptric::cad {
namespace {

/// The profile of a refined curve, with what roundings and OCCT took from it: the value of weights that are
/// all equal, and a vertex that was smooth to the last bit.
Profile restored(const Profile& given, const Handle(Geom_BSplineCurve) & curve) {
  const Profile refined = detail::profile_of(curve);
  std::vector<ControlPoint> points = refined.points();
  if (!given.is_rational())
    for (ControlPoint& point : points) point.weight = given.points().front().weight;
  if (given.degree() > 1 && given.points()[1].z_mm == given.points()[0].z_mm) points[1].z_mm = points[0].z_mm;
  return Profile(refined.degree(), refined.knots(), std::move(points));
}

void require_inside(const Profile& profile, std::span<const double> knots) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  for (const double knot : knots)
    if (!(knot > profile.first_parameter() && knot < profile.last_parameter()))
      throw InputError({fmt::format("new knot {} lies outside the curve", knot), "",
                        fmt::format("new knots lie between {} and {}", profile.first_parameter(),
                                    profile.last_parameter()),
                        ""});
  for (const double knot : knots) {
    const auto times = std::count(knots.begin(), knots.end(), knot) +
                       std::count(profile.knots().begin(), profile.knots().end(), knot);
    if (times > profile.degree())
      throw InputError({fmt::format("knot {} would be repeated {} times", knot, times), "",
                        fmt::format("at most {} times, the degree", profile.degree()), ""});
  }
}

}  // namespace

Profile elevated(const Profile& profile, int degree) {
  if (degree < profile.degree() || degree > 9)
    throw InputError({fmt::format("degree {} cannot be raised to {}", profile.degree(), degree), "",
                      "the new degree lies between the present one and 9", ""});
  if (degree == profile.degree()) return profile;
  const Handle(Geom_BSplineCurve) curve = detail::occt_curve(profile);
  detail::guarded("raise the generatrix' degree", "", [&] {
    detail::clamp(curve);  // IncreaseDegree leaves other ends inconsistent
    curve->IncreaseDegree(degree);
  });
  return restored(profile, curve);
}

Profile with_knots(const Profile& profile, std::span<const double> new_knots) {
  require_inside(profile, new_knots);  // first: with NaN there is no order
  std::vector<double> sorted(new_knots.begin(), new_knots.end());
  std::sort(sorted.begin(), sorted.end());
  if (sorted.empty()) return profile;
  std::vector<double> values = sorted;
  values.erase(std::unique(values.begin(), values.end()), values.end());
  TColStd_Array1OfReal knots(1, static_cast<int>(values.size()));
  TColStd_Array1OfInteger multiplicities(1, knots.Length());
  for (int i = 1; i <= knots.Length(); ++i) {
    knots(i) = values[static_cast<std::size_t>(i - 1)];
    multiplicities(i) = static_cast<int>(std::count(sorted.begin(), sorted.end(), knots(i)));
  }
  const Handle(Geom_BSplineCurve) curve = detail::occt_curve(profile);
  detail::guarded("insert knots into the generatrix", "", [&] {
    detail::clamp(curve);
    curve->InsertKnots(knots, multiplicities, 0., Standard_True);  // 0: only equal doubles are one knot
  });
  return restored(profile, curve);
}

Profile split_spans(const Profile& profile, int parts) {
  if (parts < 1)
    throw InputError({fmt::format("a span cannot be cut into {} parts", parts), "", "1 part or more", ""});
  std::vector<double> knots;
  for (const RationalSpan& span : profile.spans())
    for (int i = 1; i < parts; ++i) {
      const double knot = span.first + (span.last - span.first) * i / parts;
      if (!(knot > (knots.empty() ? span.first : std::max(span.first, knots.back())) && knot < span.last))
        throw InputError(
            {fmt::format("the span from {} to {} is too short for {} parts", span.first, span.last, parts),
             "", "no further doubles lie between its ends", "fewer parts"});
      knots.push_back(knot);
    }
  return with_knots(profile, knots);
}

}  // namespace catoptric::cad
