#include "cad/detail/meridian_frame.h"

#include <fmt/format.h>
#include <ElCLib.hxx>
#include <gp_Lin.hxx>

#include <algorithm>
#include <array>
#include <cmath>

#include "cad/detail/curve_source.h"

namespace catoptric::cad::detail {
namespace {

constexpr int samples = 256;

gp_Pnt sample(const Handle(Geom_BSplineCurve) & curve, int i) {
  return curve->Value(curve->FirstParameter() +
                      (curve->LastParameter() - curve->FirstParameter()) * i / samples);
}

double size_of(const Handle(Geom_BSplineCurve) & curve) {
  double size = 0;
  for (int i = 1; i <= samples; ++i) size = std::max(size, sample(curve, 0).Distance(sample(curve, i)));
  return size;
}

gp_Vec radial(const gp_Pnt& point, const gp_Lin& axis) {
  return gp_Vec(ElCLib::Value(ElCLib::Parameter(axis, point), axis), point);
}

/// Direction of the half-plane: of the farthest point of the curve.
gp_Vec farthest_radial(const Handle(Geom_BSplineCurve) & curve, const gp_Lin& axis) {
  gp_Vec farthest(0., 0., 0.);
  for (int i = 0; i <= samples; ++i) {
    const gp_Vec here = radial(sample(curve, i), axis);
    if (here.Magnitude() > farthest.Magnitude()) farthest = here;
  }
  return farthest;
}

/// What keeps the curve from being a meridian; no meridian and no fault when nothing does.
MeridianView faults_of(const Handle(Geom_BSplineCurve) & curve, const gp_Lin& axis, const gp_Dir& outward,
                       double tolerance_mm) {
  double off_plane = 0, least_r = HUGE_VAL;
  for (int i = 0; i <= samples; ++i) {
    const gp_Vec here = radial(sample(curve, i), axis);
    const double r = here.Dot(gp_Vec(outward));
    off_plane = std::max(off_plane, (here - r * gp_Vec(outward)).Magnitude());
    least_r = std::min(least_r, r);
  }
  if (off_plane > tolerance_mm)
    return {std::nullopt, fmt::format("the curve leaves the plane through the axis by {:.6g} mm", off_plane),
            false};
  if (least_r < -tolerance_mm)
    return {std::nullopt, fmt::format("the curve crosses the axis by {:.6g} mm", -least_r), true};
  return {std::nullopt, "", true};
}

}  // namespace

gp_Ax1 from_origin(const gp_Ax1& axis) {
  const gp_Lin line(axis);
  return gp_Ax1(ElCLib::Value(ElCLib::Parameter(line, gp_Pnt(0., 0., 0.)), line), axis.Direction());
}

MeridianView see_from_axis(const Handle(Geom_BSplineCurve) & given, const gp_Ax1& axis) {
  const gp_Lin line(axis);
  const double tolerance_mm = import_rel * size_of(given);
  const gp_Vec far = farthest_radial(given, line);
  if (far.Magnitude() <= tolerance_mm) return {std::nullopt, "the curve lies on the axis", true};
  const gp_Dir outward(far);
  if (MeridianView fault = faults_of(given, line, outward, tolerance_mm); !fault.fault.empty()) return fault;
  MeridianCurve result;
  result.curve = Handle(Geom_BSplineCurve)::DownCast(given->Copy());
  if (result.curve->IsPeriodic()) result.curve->SetNotPeriodic();
  const double r_start = radial(given->StartPoint(), line).Dot(gp_Vec(outward));
  const double r_end = radial(given->EndPoint(), line).Dot(gp_Vec(outward));
  for (int i = 1; i <= result.curve->NbPoles(); ++i) {
    const gp_Pnt pole = result.curve->Pole(i);
    const gp_Vec out = radial(pole, line);
    double r = out.Dot(gp_Vec(outward));
    result.moved_mm = std::max(result.moved_mm, (out - r * gp_Vec(outward)).Magnitude());
    const bool is_end = i == 1 || i == result.curve->NbPoles();
    if (is_end && std::abs(r) <= tolerance_mm) {
      result.moved_mm = std::max(result.moved_mm, std::abs(r));
      r = 0;
    }
    result.curve->SetPole(i, gp_Pnt(r, 0., ElCLib::Parameter(line, pole)));
  }
  if (r_start > r_end + tolerance_mm) {
    result.curve->Reverse();
    result.turned_round = true;
  }
  return {result, "", true};
}

std::optional<PrincipalAxis> nearest_principal_axis(const Handle(Geom_BSplineCurve) & curve) {
  const std::array<PrincipalAxis, 3> axes{PrincipalAxis{gp::OZ(), "z", ""}, PrincipalAxis{gp::OY(), "y", ""},
                                          PrincipalAxis{gp::OX(), "x", ""}};
  const double tolerance_mm = import_rel * size_of(curve);
  const auto distance = [&](const PrincipalAxis& each) {
    const gp_Lin line(each.axis);
    return std::min(line.Distance(curve->StartPoint()), line.Distance(curve->EndPoint()));
  };
  std::optional<PrincipalAxis> best;
  for (const PrincipalAxis& each : axes)
    if (see_from_axis(curve, each.axis).is_in_plane &&
        (!best || distance(each) < distance(*best) - tolerance_mm))
      best = each;
  if (!best) return std::nullopt;
  const bool touches = distance(*best) <= tolerance_mm;
  for (const PrincipalAxis& each : axes)
    if (each.name != best->name && see_from_axis(curve, each.axis).meridian &&
        (!touches || distance(each) <= tolerance_mm))
      best->rivals += (best->rivals.empty() ? "" : " or ") + each.name;
  return best;
}

}  // namespace catoptric::cad::detail
