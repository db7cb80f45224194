#include "design/free_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/contract.h"

namespace catoptric::design {
namespace {

using Index = std::size_t;

/// A vertex whose control polygon leaves it flatter than this is meant to be smooth: files carry 10 digits.
constexpr double smooth_slope = 1e-9;

bool clamped(const Profile& profile) {
  const Index p = static_cast<Index>(profile.degree());
  const std::vector<double>& knots = profile.knots();
  return knots.front() == knots[p] && knots.back() == knots[knots.size() - 1 - p];
}

/// Whether the gauge holds each point's weight: the first one, and the last one of each stretch that is a
/// single span.
std::vector<bool> held_weights(const Profile& profile) {
  const Index p = static_cast<Index>(profile.degree());
  const std::vector<double>& knots = profile.knots();
  std::vector<bool> held(profile.points().size(), false);
  held.front() = true;
  // Point i is on the curve, and a stretch ends there, where knots i + 1 ... i + degree are one.
  Index begin = 0;
  for (Index i = 1; i < held.size(); ++i) {
    if (knots[i + 1] != knots[i + p]) continue;
    if (i == begin + p) held[i] = true;
    begin = i;
  }
  return held;
}

double extent_mm(const Profile& profile) {
  return std::hypot(profile.r_max_mm(), profile.z_max_mm() - profile.z_min_mm());
}

}  // namespace

FreeProfileOptions package_about(const Profile& base, LengthUnit unit) {
  double r_most = 0, z_least = HUGE_VAL, z_most = -HUGE_VAL;
  for (const ControlPoint& point : base.points()) {
    r_most = std::max(r_most, point.r_mm);
    z_least = std::min(z_least, point.z_mm);
    z_most = std::max(z_most, point.z_mm);
  }
  const double margin_mm = 0.5 * extent_mm(base);
  FreeProfileOptions options;
  options.unit = unit;
  options.r_greatest_mm = r_most + margin_mm;
  options.z_least_mm = z_least - margin_mm;
  options.z_greatest_mm = z_most + margin_mm;
  return options;
}

FreeProfile::FreeProfile(Profile base, const FreeProfileOptions& options)
    : base_(std::move(base)), options_(options), unit_mm_(millimetres_per(options.unit)) {
  if (!clamped(base_))
    throw InputError({"the generatrix does not begin and end at its first and last control point", "",
                      "a free profile needs knots repeated degree + 1 times at both ends",
                      "leave the knots out"});
  extent_mm_ = extent_mm(base_);
  const FreeProfileOptions about = package_about(base_, options.unit);
  if (!options_.r_greatest_mm) options_.r_greatest_mm = about.r_greatest_mm;
  if (!options_.z_least_mm) options_.z_least_mm = about.z_least_mm;
  if (!options_.z_greatest_mm) options_.z_greatest_mm = about.z_greatest_mm;
  const std::vector<ControlPoint>& points = base_.points();
  const ControlPoint& vertex = points[0];
  smooth_vertex_ = vertex.r_mm == 0 && base_.degree() > 1 &&
                   std::abs(points[1].z_mm - vertex.z_mm) <= smooth_slope * std::abs(points[1].r_mm);
  const std::vector<bool> held = held_weights(base_);
  for (Index i = 0; i < points.size(); ++i) {
    if (i > 0) freedoms_.push_back({Kind::r, i});
    const bool z_free = i == 0 ? !options_.hold_vertex : !(i == 1 && smooth_vertex_);
    if (z_free) freedoms_.push_back({Kind::z, i});
    if (!held[i]) freedoms_.push_back({Kind::log_weight, i});
  }
  for (const optim::Variable& each : variables())
    if (!(each.start >= each.lower && each.start <= each.upper))
      throw InputError({fmt::format("{} = {} of the reflector lies outside its package, [{}, {}] {}",
                                    each.name, each.start, each.lower, each.upper, symbol(options_.unit)),
                        "", "all control points lie in the package", "move the point or widen the package"});
}

optim::Variable FreeProfile::variable(const Freedom& freedom) const {
  const ControlPoint& point = base_.points()[freedom.point];
  const double step = options_.length_step_rel * extent_mm_ / unit_mm_;
  switch (freedom.kind) {
    case Kind::r:
      return {fmt::format("r{}", freedom.point), point.r_mm / unit_mm_, step, 0.0,
              *options_.r_greatest_mm / unit_mm_};
    case Kind::z:
      return {fmt::format("z{}", freedom.point), point.z_mm / unit_mm_, step, *options_.z_least_mm / unit_mm_,
              *options_.z_greatest_mm / unit_mm_};
    default: {
      const double start = std::log(point.weight);
      const double first = std::log(base_.points().front().weight);
      return {fmt::format("logw{}", freedom.point), start, options_.log_weight_step,
              std::min(start, first + std::log(options_.least_weight_rel)),
              std::max(start, first + std::log(options_.greatest_weight_rel))};
    }
  }
}

std::vector<optim::Variable> FreeProfile::variables() const {
  std::vector<optim::Variable> list;
  for (const Freedom& freedom : freedoms_) list.push_back(variable(freedom));
  return list;
}

std::optional<Profile> FreeProfile::at(std::span<const double> values) const {
  CATOPTRIC_EXPECTS(values.size() == freedoms_.size());
  std::vector<ControlPoint> points = base_.points();
  for (Index i = 0; i < values.size(); ++i) {
    ControlPoint& point = points[freedoms_[i].point];
    switch (freedoms_[i].kind) {
      case Kind::r:
        point.r_mm = values[i] * unit_mm_;
        break;
      case Kind::z:
        point.z_mm = values[i] * unit_mm_;
        break;
      default:
        point.weight = std::exp(values[i]);
        break;
    }
  }
  if (smooth_vertex_) points[1].z_mm += points[0].z_mm - base_.points()[0].z_mm;
  if (Profile::find_defect(base_.degree(), base_.knots(), points)) return std::nullopt;
  return Profile(base_.degree(), base_.knots(), std::move(points));
}

Eigen::MatrixXd FreeProfile::chain(const Profile& profile) const {
  CATOPTRIC_EXPECTS(profile.points().size() == base_.points().size());
  Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * base_.points().size()),
                                                static_cast<Eigen::Index>(freedoms_.size()));
  for (Index i = 0; i < freedoms_.size(); ++i) {
    const auto [kind, point] = freedoms_[i];
    const Eigen::Index column = static_cast<Eigen::Index>(i), row = static_cast<Eigen::Index>(3 * point);
    if (kind == Kind::r) chain(row, column) = unit_mm_;
    if (kind == Kind::z) chain(row + 1, column) = unit_mm_;
    if (kind == Kind::z && point == 0 && smooth_vertex_) chain(row + 4, column) = unit_mm_;
    if (kind == Kind::log_weight) chain(row + 2, column) = profile.points()[point].weight;
  }
  return chain;
}

}  // namespace catoptric::design
