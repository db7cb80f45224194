#include "design/curvature_profile.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/contract.h"

namespace catoptric::design {
namespace {

using Index = std::size_t;

constexpr int least_stations = 2, most_stations = 64, points_per_station = 24;
/// A vertex on the axis that leaves it flatter than this is smooth: files carry 10 digits.
constexpr double smooth_angle_rad = 1e-9;

/// Angle of the tangent after a share of a curve of given length with these curvatures.
double angle_after(std::span<const double> curvature, double length, double share) {
  const double intervals = static_cast<double>(curvature.size() - 1), at = share * intervals;
  double sum = 0;
  for (Index j = 0; j + 1 < curvature.size(); ++j) {
    const double part = std::clamp(at - static_cast<double>(j), 0.0, 1.0);
    if (part <= 0) break;
    sum += part * (curvature[j] + 0.5 * part * (curvature[j + 1] - curvature[j]));
  }
  return sum * length / intervals;
}

/// The base walked along, at equal shares of its length.
struct Walk {
  std::vector<double> r_mm, z_mm, angle;
  double length_mm;
};

Walk walked(const Profile& base, Index intervals) {
  constexpr int finer = 40;
  const Index steps = intervals * finer;
  const double first = base.first_parameter(), range = base.last_parameter() - first;
  std::vector<double> lengths{0};
  for (Index i = 0; i < steps; ++i) {
    const MeridianPoint p =
        base.at(first + range * (static_cast<double>(i) + 0.5) / static_cast<double>(steps));
    lengths.push_back(lengths.back() + std::hypot(p.dr, p.dz) * range / static_cast<double>(steps));
  }
  Walk walk{{}, {}, {}, base.length_mm()};
  Index place = 0;
  for (Index i = 0; i <= intervals; ++i) {
    const double wanted = lengths.back() * static_cast<double>(i) / static_cast<double>(intervals);
    while (place + 1 < steps && lengths[place + 1] < wanted) ++place;
    const double part =
        std::clamp((wanted - lengths[place]) / (lengths[place + 1] - lengths[place]), 0.0, 1.0);
    const MeridianPoint p =
        base.at(first + range * (static_cast<double>(place) + part) / static_cast<double>(steps));
    walk.r_mm.push_back(p.r_mm);
    walk.z_mm.push_back(p.z_mm);
    double angle = std::atan2(p.dz, p.dr);
    if (i > 0) angle += 2 * pi * std::round((walk.angle.back() - angle) / (2 * pi));  // no jumps of a turn
    walk.angle.push_back(angle);
  }
  return walk;
}

/// Values of the clamped B-splines at a share.  @from  The NURBS Book, 2nd ed., eq. 2.5
Eigen::RowVectorXd basis_row(std::span<const double> knots, int degree, Index count, double share) {
  const Index p = static_cast<Index>(degree);
  Index span = p;
  while (span + 1 < count && share >= knots[span + 1]) ++span;
  std::vector<double> values(count + p + 1, 0.0);
  values[span] = 1;
  for (Index level = 1; level <= p; ++level)
    for (Index i = span - level; i <= span; ++i) {
      const double rise = knots[i + level] - knots[i], fall = knots[i + level + 1] - knots[i + 1];
      values[i] = (rise > 0 ? (share - knots[i]) / rise * values[i] : 0) +
                  (fall > 0 ? (knots[i + level + 1] - share) / fall * values[i + 1] : 0);
    }
  return Eigen::Map<const Eigen::RowVectorXd>(values.data(), static_cast<Eigen::Index>(count));
}

/// Curvatures whose angles come nearest to those walked.
std::vector<double> nearest_curvatures(const Walk& walk, int stations, double first_angle) {
  const auto rows = static_cast<Eigen::Index>(walk.angle.size());
  Eigen::MatrixXd system(rows, stations);
  Eigen::VectorXd wanted(rows);
  std::vector<double> unit(static_cast<Index>(stations), 0.0);
  for (int j = 0; j < stations; ++j) {
    unit[static_cast<Index>(j)] = 1;
    for (Eigen::Index i = 0; i < rows; ++i)
      system(i, j) =
          angle_after(unit, walk.length_mm, static_cast<double>(i) / static_cast<double>(rows - 1));
    unit[static_cast<Index>(j)] = 0;
  }
  for (Eigen::Index i = 0; i < rows; ++i) wanted[i] = walk.angle[static_cast<Index>(i)] - first_angle;
  const Eigen::VectorXd solved = system.colPivHouseholderQr().solve(wanted);
  return {solved.begin(), solved.end()};
}

}  // namespace

CurvatureProfile::CurvatureProfile(const Profile& base, const CurvatureProfileOptions& options)
    : options_(options), unit_mm_(millimetres_per(options.unit)) {
  if (options.stations < least_stations || options.stations > most_stations)
    throw InputError({fmt::format("{} curvature stations", options.stations), "",
                      fmt::format("{} to {} are possible", least_stations, most_stations), ""});
  if (options.degree < 3 || options.degree > 9)
    throw InputError({fmt::format("degree {} cannot follow a curvature", options.degree), "",
                      "degrees 3 to 9 have a continuous one", ""});
  prepare_fit();
  const Walk walk = walked(base, shares_.size() - 1);
  first_r_mm_ = walk.r_mm.front();
  first_z_mm_ = walk.z_mm.front();
  first_angle_ = walk.angle.front();
  angle_free_ = first_r_mm_ != 0 || std::abs(first_angle_) > smooth_angle_rad;
  if (!angle_free_) first_angle_ = 0;
  const double length = walk.length_mm / unit_mm_;
  if (!options.hold_vertex)
    variables_.push_back({"z0", first_z_mm_ / unit_mm_, options.length_step_rel * length,
                          first_z_mm_ / unit_mm_ - 0.5 * length, first_z_mm_ / unit_mm_ + 0.5 * length});
  if (angle_free_)
    variables_.push_back(
        {"angle0", first_angle_, options.angle_step_rad, first_angle_ - 1, first_angle_ + 1});
  const std::vector<double> curvature = nearest_curvatures(walk, options.stations, first_angle_);
  double most = 1 / walk.length_mm;  // so that a straight base may bend by a radian
  for (const double each : curvature) most = std::max(most, std::abs(each));
  most *= unit_mm_;
  for (Index j = 0; j < curvature.size(); ++j) {
    const double start = curvature[j] * unit_mm_;
    variables_.push_back({fmt::format("kappa{}", j), start, options.curvature_step_rel * most,
                          start - 4 * most, start + 4 * most});
  }
  variables_.push_back({"length", length, options.length_step_rel * length, 0.3 * length, 3 * length});
  std::vector<double> starts;
  for (const auto& variable : variables_) starts.push_back(variable.start);
  const Curve curve = integrated(starts);
  for (Index i = 0; i < shares_.size(); ++i)
    start_error_mm_ =
        std::max(start_error_mm_, std::hypot(curve.r_mm[i] - walk.r_mm[i], curve.z_mm[i] - walk.z_mm[i]));
}

void CurvatureProfile::prepare_fit() {
  const int spans = 2 * (options_.stations - 1);
  const Index count = static_cast<Index>(spans + options_.degree);
  knots_ = Profile::uniform_knots(options_.degree, count);
  const int intervals = points_per_station * (options_.stations - 1);
  basis_.resize(intervals + 1, static_cast<Eigen::Index>(count));
  for (int i = 0; i <= intervals; ++i) {
    shares_.push_back(static_cast<double>(i) / intervals);
    basis_.row(i) = basis_row(knots_, options_.degree, count, shares_.back());
  }
  const Eigen::MatrixXd inner = basis_.middleCols(2, basis_.cols() - 4);
  normal_.compute(inner.transpose() * inner);
}

CurvatureProfile::Curve CurvatureProfile::integrated(std::span<const double> values) const {
  CATOPTRIC_EXPECTS(values.size() == variables_.size());
  static constexpr std::array<double, 3> node{-0.7745966692414834, 0.0, 0.7745966692414834};
  static constexpr std::array<double, 3> weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
  Index next = 0;
  const double z_mm = options_.hold_vertex ? first_z_mm_ : values[next++] * unit_mm_;
  const double first = angle_free_ ? values[next++] : first_angle_;
  std::vector<double> curvature;  // per mm
  for (int j = 0; j < options_.stations; ++j) curvature.push_back(values[next++] / unit_mm_);
  const double length_mm = values[next] * unit_mm_;
  Curve curve{{first_r_mm_}, {z_mm}, first, first + angle_after(curvature, length_mm, 1), length_mm};
  for (Index i = 0; i + 1 < shares_.size(); ++i) {
    const double width = shares_[i + 1] - shares_[i];
    double dr = 0, dz = 0;
    for (Index k = 0; k < node.size(); ++k) {
      const double share = shares_[i] + 0.5 * width * (1 + node[k]);
      const double angle = first + angle_after(curvature, length_mm, share);
      dr += weight[k] * std::cos(angle);
      dz += weight[k] * std::sin(angle);
    }
    curve.r_mm.push_back(curve.r_mm.back() + width * length_mm * dr);
    curve.z_mm.push_back(curve.z_mm.back() + width * length_mm * dz);
  }
  return curve;
}

std::vector<ControlPoint> CurvatureProfile::fitted(const Curve& curve) const {
  const Eigen::Index rows = basis_.rows(), count = basis_.cols();
  Eigen::MatrixXd wanted(rows, 2), points(count, 2);
  for (Eigen::Index i = 0; i < rows; ++i)
    wanted.row(i) << curve.r_mm[static_cast<Index>(i)], curve.z_mm[static_cast<Index>(i)];
  // Ends and their directions are exact: the curve passes its length at speed 1.
  const double reach = curve.length_mm * knots_[static_cast<Index>(options_.degree) + 1] / options_.degree;
  points.row(0) = wanted.row(0);
  points.row(count - 1) = wanted.row(rows - 1);
  points.row(1) =
      points.row(0) + reach * Eigen::RowVector2d(std::cos(curve.first_angle), std::sin(curve.first_angle));
  points.row(count - 2) = points.row(count - 1) -
                          reach * Eigen::RowVector2d(std::cos(curve.last_angle), std::sin(curve.last_angle));
  const Eigen::MatrixXd rest =
      wanted - basis_.leftCols(2) * points.topRows(2) - basis_.rightCols(2) * points.bottomRows(2);
  points.middleRows(2, count - 4) = normal_.solve(basis_.middleCols(2, count - 4).transpose() * rest);
  std::vector<ControlPoint> control;
  for (Eigen::Index i = 0; i < count; ++i) control.push_back({points(i, 0), points(i, 1), 1.0});
  return control;
}

std::optional<Profile> CurvatureProfile::at(std::span<const double> values) const {
  std::vector<ControlPoint> points = fitted(integrated(values));
  if (Profile::find_defect(options_.degree, knots_, points)) return std::nullopt;
  return Profile(options_.degree, knots_, std::move(points));
}

double CurvatureProfile::fit_error_mm(std::span<const double> values) const {
  const auto profile = at(values);
  if (!profile) return HUGE_VAL;
  const Curve curve = integrated(values);
  double greatest = 0;
  for (Index i = 0; i < shares_.size(); ++i) {
    const MeridianPoint p = profile->at(shares_[i]);
    greatest = std::max(greatest, std::hypot(p.r_mm - curve.r_mm[i], p.z_mm - curve.z_mm[i]));
  }
  return greatest;
}

}  // namespace catoptric::design
