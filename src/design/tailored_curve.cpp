#include "design/tailored_curve.h"

#include <fmt/format.h>

#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>

#include "base/contract.h"
#include "base/units.h"

namespace catoptric::design {
namespace {

/// Logarithm of the distance from the source over that of the apex: no number here has a scale.
using State = std::array<double, 1>;

struct RunsAway {
  double angle_rad;
};

class RayEquation {
 public:
  RayEquation(const FluxMap& map, const AxialLayout& layout, RayMap kind, double apex_distance_mm)
      : map_(map),
        layout_(layout),
        side_(kind == RayMap::crossing ? -1.0 : 1.0),
        apex_distance_mm_(apex_distance_mm) {}

  /// d log(distance) / d angle: the normal halves the angle between the ray and the way to its landing point.
  double slope(double log_distance, double angle) const {
    const double distance = distance_mm(log_distance), sine = std::sin(angle), cosine = std::cos(angle);
    const double r = distance * sine, z = layout_.source_z_mm + layout_.apex_side * distance * cosine;
    const double to_r = side_ * map_.at(angle).radius_mm - r, to_z = layout_.field_z_mm - z;
    const double way = std::hypot(to_r, to_z);
    const double along = (to_r * sine + to_z * layout_.apex_side * cosine) / way;
    const double across = (to_r * cosine - to_z * layout_.apex_side * sine) / way;
    // A ray that went on as it came would need a mirror seen edge-on.
    constexpr double straight = 1e-9;
    if (!(1 - along > straight) || !std::isfinite(distance)) throw RunsAway{angle};
    return across / (1 - along);
  }

  CurvePoint point(double log_distance, double angle) const {
    const double distance = distance_mm(log_distance), sine = std::sin(angle), cosine = std::cos(angle);
    const double grows = distance * slope(log_distance, angle);
    return {angle, distance * sine, layout_.source_z_mm + layout_.apex_side * distance * cosine,
            grows * sine + distance * cosine, layout_.apex_side * (grows * cosine - distance * sine)};
  }

 private:
  double distance_mm(double log_distance) const { return apex_distance_mm_ * std::exp(log_distance); }

  const FluxMap& map_;
  const AxialLayout& layout_;
  double side_, apex_distance_mm_;
};

}  // namespace

std::string_view name(RayMap map) { return map == RayMap::crossing ? "crossing" : "diverging"; }

std::variant<std::vector<CurvePoint>, std::string> tailored_curve(const FluxMap& map,
                                                                  const AxialLayout& layout, RayMap kind,
                                                                  double apex_distance_mm,
                                                                  const std::vector<double>& angles_rad) {
  CATOPTRIC_EXPECTS(apex_distance_mm > 0 && !angles_rad.empty() && angles_rad.front() > 0);
  namespace odeint = boost::numeric::odeint;
  constexpr double tolerance = 1e-10;
  const RayEquation equation(map, layout, kind, apex_distance_mm);
  const auto right_side = [&](const State& at, State& slope, double angle) {
    slope[0] = equation.slope(at[0], angle);
  };
  State at{0};
  std::vector<CurvePoint> points;
  try {
    points.push_back(equation.point(at[0], 0));
    double from = 0;
    // Steps end at every angle asked for, so that breaks among them are never stepped over.
    for (const double to : angles_rad) {
      CATOPTRIC_EXPECTS(to > from);
      odeint::integrate_adaptive(
          odeint::make_controlled<odeint::runge_kutta_dopri5<State>>(tolerance, tolerance), right_side, at,
          from, to, 0.5 * (to - from));
      points.push_back(equation.point(at[0], to));
      from = to;
    }
  } catch (const RunsAway& away) {
    return fmt::format("the mirror would be seen edge-on under {:.4g} degrees from the axis",
                       away.angle_rad * 180 / pi);
  }
  return points;
}

}  // namespace catoptric::design
