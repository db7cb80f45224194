#include "cad/detail/occt_curve.h"

#include <Precision.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <algorithm>
#include <cmath>

#include "base/tolerance.h"
#include "cad/detail/occt_guard.h"

namespace catoptric::cad::detail {
namespace {

struct Knots {
  std::vector<double> values;
  std::vector<int> multiplicities;
};

Knots group(const std::vector<double>& flat) {
  Knots knots;
  for (double value : flat) {
    if (knots.values.empty() || value != knots.values.back()) {
      knots.values.push_back(value);
      knots.multiplicities.push_back(0);
    }
    ++knots.multiplicities.back();
  }
  return knots;
}

/// A factor that brings all weights into the range a Profile allows, 1 when they are there already. A power
/// of two, so that no digit of a weight changes.
double weight_factor(const Geom_BSplineCurve& curve) {
  double least = HUGE_VAL, greatest = 0;
  for (int i = 1; i <= curve.NbPoles(); ++i) {
    least = std::min(least, curve.Weight(i));
    greatest = std::max(greatest, curve.Weight(i));
  }
  if (least >= least_weight && greatest <= greatest_weight) return 1;
  const double middle = std::sqrt(least) * std::sqrt(greatest);
  return std::isfinite(middle) && middle > 0 ? std::exp2(-std::round(std::log2(middle))) : 1;
}

}  // namespace

Handle(Geom_BSplineCurve) occt_curve(const Profile& profile, double scale) {
  return guarded("build the generatrix", "", [&] {
    const int count = static_cast<int>(profile.points().size());
    TColgp_Array1OfPnt poles(1, count);
    TColStd_Array1OfReal weights(1, count);
    for (int i = 1; i <= count; ++i) {
      const ControlPoint& point = profile.points()[static_cast<std::size_t>(i - 1)];
      poles(i) = gp_Pnt(scale * point.r_mm, 0., scale * point.z_mm);
      weights(i) = point.weight;
    }
    const Knots grouped = group(profile.knots());
    const int distinct = static_cast<int>(grouped.values.size());
    TColStd_Array1OfReal knots(1, distinct);
    TColStd_Array1OfInteger multiplicities(1, distinct);
    for (int i = 1; i <= distinct; ++i) {
      knots(i) = grouped.values[static_cast<std::size_t>(i - 1)];
      multiplicities(i) = grouped.multiplicities[static_cast<std::size_t>(i - 1)];
    }
    return Handle(Geom_BSplineCurve)(
        new Geom_BSplineCurve(poles, weights, knots, multiplicities, profile.degree()));
  });
}

void clamp(const Handle(Geom_BSplineCurve) & curve) {
  if (curve->Multiplicity(1) <= curve->Degree() || curve->Multiplicity(curve->NbKnots()) <= curve->Degree())
    curve->Segment(curve->FirstParameter(), curve->LastParameter());
}

Handle(Geom_BSplineCurve) occt_cad_curve(const Profile& profile, double scale) {
  Handle(Geom_BSplineCurve) curve = occt_curve(profile, scale);
  return guarded("set the generatrix on the axis", "", [&] {
    clamp(curve);
    for (const auto& [index, end] :
         {std::pair{1, curve->StartPoint()}, std::pair{curve->NbPoles(), curve->EndPoint()}}) {
      const gp_Pnt pole = curve->Pole(index);
      if (std::abs(end.X()) <= Precision::Confusion() && std::abs(pole.X()) <= Precision::Confusion())
        curve->SetPole(index, gp_Pnt(0., 0., pole.Z()));
    }
    return curve;
  });
}

Profile profile_of(const Handle(Geom_BSplineCurve) & given, double scale) {
  struct Numbers {
    int degree = 0;
    std::vector<double> knots;
    std::vector<ControlPoint> points;
  };
  Numbers numbers = guarded("read the curve's poles", "", [&] {
    Handle(Geom_BSplineCurve) curve = given;
    if (curve->IsPeriodic()) {
      curve = Handle(Geom_BSplineCurve)::DownCast(given->Copy());
      curve->SetNotPeriodic();
    }
    Numbers result;
    result.degree = curve->Degree();
    const double factor = weight_factor(*curve);
    for (int i = 1; i <= curve->NbPoles(); ++i) {
      const gp_Pnt pole = curve->Pole(i);
      result.points.push_back({scale * pole.X() + 0.0, scale * pole.Z() + 0.0, factor * curve->Weight(i)});
    }
    const TColStd_Array1OfReal& flat = curve->KnotSequence();
    for (const double knot : flat) result.knots.push_back(knot + 0.0);  // no -0
    return result;
  });
  return Profile(numbers.degree, std::move(numbers.knots), std::move(numbers.points));
}

}  // namespace catoptric::cad::detail
