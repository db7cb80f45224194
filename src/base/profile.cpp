#include "base/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/bernstein.h"
#include "base/float_traps.h"
#include "base/profile_hull.h"
#include "base/profile_limits.h"
#include "base/tolerance.h"
#include "base/units.h"

namespace catoptric {
namespace {

using Index = std::size_t;

/// Value of the blossom of segment [knots[span], knots[span + 1]] for `arguments` (degree of them).
/// @from  The NURBS Book, ch. 5 (knot insertion); Ramshaw 1987 (blossoming)
double blossom(int degree, std::span<const double> knots, Index span, std::span<const double> poles,
               std::span<const double> arguments) {
  const Index p = static_cast<Index>(degree);
  std::vector<double> work(poles.begin() + static_cast<std::ptrdiff_t>(span - p),
                           poles.begin() + static_cast<std::ptrdiff_t>(span + 1));
  for (Index level = 1; level <= p; ++level) {
    const double u = arguments[level - 1];
    for (Index i = p; i >= level; --i) {
      const double low = knots[span - p + i];
      const double high = knots[span + i + 1 - level];
      const double share = (u - low) / (high - low);
      work[i] = (1 - share) * work[i - 1] + share * work[i];
    }
  }
  return work[p];
}

std::vector<RationalSpan> split_into_spans(int degree, std::span<const double> knots,
                                           std::span<const ControlPoint> points) {
  const Index p = static_cast<Index>(degree);
  std::vector<double> rw, zw, w;
  for (const ControlPoint& point : points) {
    rw.push_back(point.weight * point.r_mm);
    zw.push_back(point.weight * point.z_mm);
    w.push_back(point.weight);
  }
  std::vector<RationalSpan> spans;
  for (Index i = p; i < points.size(); ++i) {
    if (knots[i] == knots[i + 1]) continue;
    RationalSpan span{knots[i], knots[i + 1], {}, {}, {}};
    std::vector<double> arguments(p);
    for (Index j = 0; j <= p; ++j) {
      for (Index a = 0; a < p; ++a) arguments[a] = a < p - j ? span.first : span.last;
      span.rw.push_back(blossom(degree, knots, i, rw, arguments));
      span.zw.push_back(blossom(degree, knots, i, zw, arguments));
      span.w.push_back(blossom(degree, knots, i, w, arguments));
    }
    if (!spans.empty()) {  // one shared end, bit for bit
      span.rw.front() = spans.back().rw.back();
      span.zw.front() = spans.back().zw.back();
      span.w.front() = spans.back().w.back();
    }
    spans.push_back(std::move(span));
  }
  return spans;
}

std::optional<ErrorParts> find_knot_defect(int degree, std::span<const double> knots, Index point_count) {
  const UntrappedFloats untrapped;  // NaN is one of the defects
  const Index p = static_cast<Index>(degree);
  if (knots.size() != point_count + p + 1)
    return ErrorParts{
        fmt::format("{} knots for {} control points of degree {}", knots.size(), point_count, degree), "",
        fmt::format("control points + degree + 1 = {} knots are needed, each repeated by its "
                    "multiplicity",
                    point_count + p + 1),
        "leave the knots out to have them spaced equally"};
  for (Index i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i]))
      return ErrorParts{fmt::format("knot {} is not a finite number", i), "", "", "write a number"};
    if (i > 0 && knots[i] < knots[i - 1])
      return ErrorParts{
          fmt::format("knot {} ({}) is less than the one before it ({})", i, knots[i], knots[i - 1]), "",
          "knots never decrease", "sort them"};
  }
  if (!(knots[p] < knots[point_count]))
    return ErrorParts{"the knots leave no span", "",
                      fmt::format("knot {} must be less than knot {}", p, point_count),
                      "check the multiplicities"};
  Index run = 1;
  for (Index i = 1; i < knots.size(); ++i) {
    run = knots[i] == knots[i - 1] ? run + 1 : 1;
    const bool interior = knots[i] > knots[p] && knots[i] < knots[point_count];
    if (run > (interior ? p : p + 1))
      return ErrorParts{
          fmt::format("knot value {} is repeated {} times", knots[i], run), "",
          fmt::format("at most {} times inside and {} at the ends, or the curve breaks", p, p + 1),
          "remove one"};
  }
  return std::nullopt;
}

std::optional<ErrorParts> find_point_defect(std::span<const ControlPoint> points) {
  const UntrappedFloats untrapped;  // NaN is one of the defects
  for (Index i = 0; i < points.size(); ++i) {
    const ControlPoint& point = points[i];
    if (!std::isfinite(point.r_mm) || !std::isfinite(point.z_mm))
      return ErrorParts{fmt::format("control point {} is not finite", i), "", "", "write finite coordinates"};
    if (!(point.weight >= least_weight && point.weight <= greatest_weight))
      return ErrorParts{fmt::format("weight {} of control point {} is out of range", point.weight, i), "",
                        fmt::format("weights lie between {} and {}", least_weight, greatest_weight),
                        "divide all weights by a common factor; the shape stays the same"};
  }
  return std::nullopt;
}

/// Gauss-Legendre on one span, subdivided until two levels agree.
template <typename Function>
double integrate(const Function& f, double a, double b, double tolerance, int depth) {
  static constexpr std::array<double, 5> node{-0.9061798459386640, -0.5384693101056831, 0.0,
                                              0.5384693101056831, 0.9061798459386640};
  static constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                                0.4786286704993665, 0.2369268850561891};
  const auto rule = [&](double low, double high) {
    double sum = 0;
    for (Index i = 0; i < node.size(); ++i)
      sum += weight[i] * f(0.5 * (low + high) + 0.5 * (high - low) * node[i]);
    return 0.5 * (high - low) * sum;
  };
  const double middle = 0.5 * (a + b);
  const double whole = rule(a, b);
  const double halves = rule(a, middle) + rule(middle, b);
  if (depth == 0 || std::abs(whole - halves) <= tolerance) return halves;
  return integrate(f, a, middle, 0.5 * tolerance, depth - 1) +
         integrate(f, middle, b, 0.5 * tolerance, depth - 1);
}

template <typename Integrand>
double integrate_spans(const std::vector<RationalSpan>& spans, double scale, const Integrand& integrand) {
  constexpr double relative = 1e-10;
  double sum = 0;
  for (const RationalSpan& span : spans)
    sum += integrate([&](double s) { return integrand(evaluate(span, s)); }, 0.0, 1.0, relative * scale, 30);
  return sum;
}

}  // namespace

MeridianPoint evaluate(const RationalSpan& span, double s) {
  const Index n = span.w.size();
  constexpr Index most = 10;
  std::array<double, most> a{}, b{}, c{};
  std::copy(span.rw.begin(), span.rw.end(), a.begin());
  std::copy(span.zw.begin(), span.zw.end(), b.begin());
  std::copy(span.w.begin(), span.w.end(), c.begin());
  const double p = static_cast<double>(n - 1);
  std::array<double, 3> first{}, second{};  // derivatives of the homogeneous coordinates
  const auto step = [&](std::array<double, most>& x, Index which) {
    for (Index level = n; level-- > 1;) {
      if (level == 2) second[which] = p * (p - 1) * (x[2] - 2 * x[1] + x[0]);
      if (level == 1) first[which] = p * (x[1] - x[0]);
      for (Index i = 0; i < level; ++i) x[i] = (1 - s) * x[i] + s * x[i + 1];
    }
    return x[0];
  };
  const double rw = step(a, 0), zw = step(b, 1), w = step(c, 2);
  const double r = rw / w, z = zw / w;
  const double dr = (first[0] - first[2] * r) / w, dz = (first[1] - first[2] * z) / w;
  const double ddr = (second[0] - 2 * first[2] * dr - second[2] * r) / w;
  const double ddz = (second[1] - 2 * first[2] * dz - second[2] * z) / w;
  return {r, z, dr, dz, ddr, ddz};
}

std::optional<ErrorParts> Profile::find_defect(int degree, std::span<const double> knots,
                                               std::span<const ControlPoint> points) {
  if (degree < 1 || degree > 9)
    return ErrorParts{fmt::format("degree {} is out of range", degree), "", "degrees 1 to 9 are supported",
                      ""};
  if (points.size() < static_cast<Index>(degree) + 1)
    return ErrorParts{fmt::format("{} control points for degree {}", points.size(), degree), "",
                      "at least degree + 1 control points are needed", "add points or lower the degree"};
  if (points.size() > most_control_points)
    return ErrorParts{fmt::format("{} control points are too many", points.size()), "",
                      fmt::format("at most {} are taken", most_control_points),
                      "approximate the curve by a spline with fewer"};
  if (auto defect = find_knot_defect(degree, knots, points.size())) return defect;
  if (auto defect = find_point_defect(points)) return defect;

  double scale = 0;
  for (const ControlPoint& point : points)
    scale = std::max({scale, std::abs(point.r_mm), std::abs(point.z_mm)});
  double r_least = HUGE_VAL, r_most = -HUGE_VAL;
  for (const RationalSpan& span : split_into_spans(degree, knots, points)) {
    const Range r = range_of_r(span);
    r_least = std::min(r_least, r.least);
    r_most = std::max(r_most, r.greatest);
  }
  if (!(r_most > 0))
    return ErrorParts{"the generatrix lies on the axis", "", "a mirror needs points with r > 0",
                      "move a point out"};
  if (r_least < -Tolerance::for_scale(scale).length_mm)
    return ErrorParts{fmt::format("the generatrix crosses the axis: least r is {} mm", r_least), "",
                      "it stays in the half-plane r >= 0", "move control points away from the axis"};
  return std::nullopt;
}

Profile::Profile(int degree, std::vector<double> knots, std::vector<ControlPoint> points)
    : degree_(degree), knots_(std::move(knots)), points_(std::move(points)) {
  if (auto defect = find_defect(degree_, knots_, points_)) throw InputError(*defect);
  spans_ = split_into_spans(degree_, knots_, points_);
  z_min_mm_ = HUGE_VAL;
  z_max_mm_ = -HUGE_VAL;
  for (const RationalSpan& span : spans_) {
    const Range z = range_of_z(span);
    r_max_mm_ = std::max(r_max_mm_, range_of_r(span).greatest);
    z_min_mm_ = std::min(z_min_mm_, z.least);
    z_max_mm_ = std::max(z_max_mm_, z.greatest);
  }
}

Profile Profile::bezier(std::vector<ControlPoint> points) {
  const int degree = static_cast<int>(points.size()) - 1;
  return Profile(degree, uniform_knots(degree, points.size()), std::move(points));
}

std::vector<double> Profile::uniform_knots(int degree, std::size_t point_count) {
  std::vector<double> knots;
  const Index p = degree < 0 ? 0 : static_cast<Index>(degree);
  const Index spans = point_count > p ? point_count - p : 0;
  knots.insert(knots.end(), p + 1, 0.0);
  for (Index i = 1; i < spans; ++i) knots.push_back(static_cast<double>(i) / static_cast<double>(spans));
  knots.insert(knots.end(), p + 1, 1.0);
  return knots;
}

bool Profile::is_rational() const {
  return std::any_of(points_.begin(), points_.end(),
                     [&](const ControlPoint& point) { return point.weight != points_.front().weight; });
}

MeridianPoint Profile::at(double u) const {
  auto span =
      std::find_if(spans_.begin(), spans_.end(), [&](const RationalSpan& each) { return u <= each.last; });
  if (span == spans_.end()) span = std::prev(spans_.end());
  const double width = span->last - span->first;
  MeridianPoint point = evaluate(*span, std::clamp((u - span->first) / width, 0.0, 1.0));
  point.dr /= width;
  point.dz /= width;
  point.ddr /= width * width;
  point.ddz /= width * width;
  return point;
}

double Profile::diagonal_mm() const {
  return std::hypot(2 * r_max_mm_, 2 * r_max_mm_, z_max_mm_ - z_min_mm_);
}

double Profile::length_mm() const {
  return integrate_spans(spans_, diagonal_mm(),
                         [](const MeridianPoint& p) { return std::hypot(p.dr, p.dz); });
}

double Profile::area_mm2() const {
  return integrate_spans(spans_, diagonal_mm() * r_max_mm_,
                         [](const MeridianPoint& p) { return 2 * pi * p.r_mm * std::hypot(p.dr, p.dz); });
}

}  // namespace catoptric
