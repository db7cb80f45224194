#include "design/profile_measures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/units.h"

namespace catoptric::design {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Corners of the generatrix flatter than this are none: ten times what a smooth joint's roundings turn.
constexpr double corner_rad = 1e-7;

using Measure = std::function<double(const MeridianPoint&)>;

/// The greatest value between two places around the best of three.  @from  golden section, Kiefer 1953
double greatest_between(const std::function<double(double)>& f, double low, double high) {
  constexpr double golden = 0.6180339887498949;
  constexpr int steps = 40;  // 0.618^40 = 4e-9 of a bracket; at an extremum the value is then exact
  double a = high - golden * (high - low), b = low + golden * (high - low), fa = f(a), fb = f(b);
  for (int i = 0; i < steps; ++i) {
    if (fa < fb) {
      low = a;
      a = b;
      fa = fb;
      b = low + golden * (high - low);
      fb = f(b);
    } else {
      high = b;
      b = a;
      fb = fa;
      a = high - golden * (high - low);
      fa = f(a);
    }
  }
  return std::max(fa, fb);
}

double greatest(const Profile& profile, const Measure& measure) {
  constexpr int intervals = 128;
  constexpr double rounding = 1e-12;
  double best = -infinity;
  for (const RationalSpan& span : profile.spans()) {
    const auto f = [&](double s) { return measure(evaluate(span, s)); };
    std::vector<double> values;
    for (int i = 0; i <= intervals; ++i) values.push_back(f(static_cast<double>(i) / intervals));
    for (int i = 0; i <= intervals; ++i) {
      const int low = std::max(0, i - 1), high = std::min(intervals, i + 1);
      const double here = values[static_cast<std::size_t>(i)], before = values[static_cast<std::size_t>(low)],
                   after = values[static_cast<std::size_t>(high)];
      best = std::max(best, here);
      if (here < before || here < after) continue;
      const double bend = 2 * here - before - after;  // a parabola's top is an eighth of it higher
      if (here + bend <= best || bend <= rounding * std::abs(here)) continue;
      best = std::max(best, greatest_between(f, static_cast<double>(low) / intervals,
                                             static_cast<double>(high) / intervals));
    }
  }
  return best;
}

double speed(const MeridianPoint& p) { return std::hypot(p.dr, p.dz); }

/// Curvature, positive where the curve turns to its left; 0 where its parameter stands still.
double left_curvature(const MeridianPoint& p) {
  const double v = speed(p);
  return v > 0 ? (p.dr * p.ddz - p.dz * p.ddr) / (v * v * v) : 0.0;
}

/// Sharpest turn to the left (sign 1) or the right (-1) at a joint of spans, rad.
double sharpest_corner(const Profile& profile, double sign) {
  double sharpest = 0;
  for (std::size_t i = 1; i < profile.spans().size(); ++i) {
    const MeridianPoint before = evaluate(profile.spans()[i - 1], 1.0),
                        after = evaluate(profile.spans()[i], 0.0);
    const double turn =
        std::atan2(before.dr * after.dz - before.dz * after.dr, before.dr * after.dr + before.dz * after.dz);
    sharpest = std::max(sharpest, sign * turn);
  }
  return sharpest;
}

/// 1 when the side away from the room between mirror and axis is the generatrix's left, else -1: by the sign
/// of the integral of r dz.
double outside_sign(const Profile& profile) {
  constexpr int intervals = 64;
  double sum = 0;
  for (const RationalSpan& span : profile.spans())
    for (int i = 0; i < intervals; ++i) {
      const MeridianPoint a = evaluate(span, static_cast<double>(i) / intervals),
                          b = evaluate(span, static_cast<double>(i + 1) / intervals);
      sum += 0.5 * (a.r_mm + b.r_mm) * (b.z_mm - a.z_mm);
    }
  return sum > 0 ? -1.0 : 1.0;
}

/// Whether the control polygon never turns back in some direction: then neither does the curve (variation
/// diminishing, positive weights), and what never turns back does not cross itself.
bool polygon_advances(const Profile& profile) {
  const auto& points = profile.points();
  const double chord_r = points.back().r_mm - points.front().r_mm,
               chord_z = points.back().z_mm - points.front().z_mm;
  const double directions[][2] = {{chord_r, chord_z}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  return std::any_of(std::begin(directions), std::end(directions), [&](const auto& d) {
    for (std::size_t i = 1; i < points.size(); ++i)
      if (!(d[0] * (points[i].r_mm - points[i - 1].r_mm) + d[1] * (points[i].z_mm - points[i - 1].z_mm) > 0))
        return false;
    return true;
  });
}

/// Where two chords cross, as shares of each; nothing when they do not.
std::optional<std::pair<double, double>> crossing(const MeridianPoint& a, const MeridianPoint& b,
                                                  const MeridianPoint& c, const MeridianPoint& d) {
  const double r1 = b.r_mm - a.r_mm, z1 = b.z_mm - a.z_mm, r2 = d.r_mm - c.r_mm, z2 = d.z_mm - c.z_mm;
  const double cross = r1 * z2 - z1 * r2;
  if (cross == 0) return std::nullopt;
  const double r = c.r_mm - a.r_mm, z = c.z_mm - a.z_mm;
  const double first = (r * z2 - z * r2) / cross, second = (r * z1 - z * r1) / cross;
  if (first < 0 || first >= 1 || second < 0 || second >= 1) return std::nullopt;
  return std::pair{first, second};
}

/// Where the ray from the source by this place of the mirror goes, as the angle whose tangent is the landing
/// radius over `size_mm`; beyond a right angle the ray never meets the plane.
double landing_angle(const MeridianPoint& p, double source_z_mm, double field_z_mm, double size_mm) {
  const double way_r = p.r_mm, way_z = p.z_mm - source_z_mm;
  // 2 (d.t) t - d keeps the part along the mirror and turns the part across it
  const double along = 2 * (way_r * p.dr + way_z * p.dz), v2 = p.dr * p.dr + p.dz * p.dz;
  const double out_r = along * p.dr - v2 * way_r, out_z = along * p.dz - v2 * way_z;
  const double side = field_z_mm >= p.z_mm ? 1.0 : -1.0;
  return std::atan2(side * (p.r_mm * out_z + (field_z_mm - p.z_mm) * out_r) / size_mm, side * out_z);
}

}  // namespace

double least_curvature_radius_mm(const Profile& profile) {
  if (sharpest_corner(profile, 1) > corner_rad || sharpest_corner(profile, -1) > corner_rad) return 0.0;
  const double most = greatest(profile, [](const MeridianPoint& p) { return std::abs(left_curvature(p)); });
  return most > 0 ? 1 / most : infinity;
}

double greatest_wall_mm(const Profile& profile, bool outside) {
  const double side = outside_sign(profile) * (outside ? 1 : -1);
  if (sharpest_corner(profile, side) > corner_rad) return 0.0;
  const double most = greatest(profile, [&](const MeridianPoint& p) {
    const double v = speed(p);
    // the second principal curvature: the normal meets the axis after r v / (its radial part)
    const double towards_axis = p.r_mm > 0 && v > 0 ? side * p.dz / (v * p.r_mm) : 0.0;
    return std::max(side * left_curvature(p), towards_axis);
  });
  return most > 0 ? 1 / most : infinity;
}

double least_draft_rad(const Profile& profile) {
  const MeridianPoint first = profile.at(profile.first_parameter()),
                      last = profile.at(profile.last_parameter());
  const double outward = last.r_mm >= first.r_mm ? 1.0 : -1.0;
  return -greatest(profile, [&](const MeridianPoint& p) {
    return speed(p) > 0 ? -std::atan2(outward * p.dr, std::abs(p.dz)) : -0.5 * pi;
  });
}

Loops loops(const Profile& profile) {
  if (polygon_advances(profile)) return {0.0, true};
  constexpr int chords = 64;
  std::vector<MeridianPoint> points;
  for (const RationalSpan& span : profile.spans())
    for (int i = points.empty() ? 0 : 1; i <= chords; ++i)
      points.push_back(evaluate(span, static_cast<double>(i) / chords));
  std::vector<double> way{0.0};
  for (std::size_t i = 1; i < points.size(); ++i)
    way.push_back(way.back() +
                  std::hypot(points[i].r_mm - points[i - 1].r_mm, points[i].z_mm - points[i - 1].z_mm));
  double looped = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    for (std::size_t j = i + 2; j + 1 < points.size(); ++j)
      if (const auto at = crossing(points[i], points[i + 1], points[j], points[j + 1]))
        looped += (1 - at->second) * way[j] + at->second * way[j + 1] - (1 - at->first) * way[i] -
                  at->first * way[i + 1];
  return {std::min(1.0, looped / way.back()), false};
}

double backward_share(const Profile& profile, double source_z_mm, double field_z_mm, double size_mm) {
  constexpr int intervals = 256;
  constexpr double rounding = 1e-9;  // of a right angle: all rays land in one point, or a turn is rounding
  double way = 0, net = 0;
  std::optional<double> before;
  const auto go_to = [&](double angle) {
    if (before) {
      const double step = std::remainder(angle - *before, 2 * pi);
      way += std::abs(step);
      net += step;
    }
    before = angle;
  };
  for (const RationalSpan& span : profile.spans()) {
    const auto angle = [&](double s) {
      return landing_angle(evaluate(span, s), source_z_mm, field_z_mm, size_mm);
    };
    std::vector<double> angles;
    for (int i = 0; i <= intervals; ++i) angles.push_back(angle(static_cast<double>(i) / intervals));
    for (std::size_t i = 0; i < angles.size(); ++i) {
      double here = angles[i];
      if (i > 0 && i + 1 < angles.size()) {  // a turn: go all the way to it
        const double low = static_cast<double>(i - 1) / intervals,
                     high = static_cast<double>(i + 1) / intervals;
        const double came = std::remainder(angles[i] - angles[i - 1], 2 * pi),
                     goes = std::remainder(angles[i + 1] - angles[i], 2 * pi);
        const double sign = came > 0 ? 1.0 : -1.0;
        if (came * goes < 0)
          here = angles[i] +
                 sign * greatest_between(
                            [&](double s) { return sign * std::remainder(angle(s) - angles[i], 2 * pi); },
                            low, high);
      }
      go_to(here);
    }
  }
  if (way < rounding) return 0.0;
  const double share = 0.5 * (way - std::abs(net)) / way;
  return share < rounding ? 0.0 : share;
}

}  // namespace catoptric::design
