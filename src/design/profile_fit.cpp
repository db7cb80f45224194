#include "design/profile_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/contract.h"
#include "base/spline_basis.h"

namespace catoptric::design {

std::vector<double> knots_with_breaks(int degree, std::size_t points, const std::vector<double>& breaks) {
  const std::size_t p = static_cast<std::size_t>(degree);
  CATOPTRIC_EXPECTS(p >= 1 && points > p);
  const std::size_t inner = points - p - 1, each = std::max<std::size_t>(1, p - 1);
  const std::size_t served = std::min(breaks.size(), inner / each);
  std::vector<double> ends{0.0};
  ends.insert(ends.end(), breaks.begin(), breaks.begin() + static_cast<std::ptrdiff_t>(served));
  ends.push_back(1.0);
  // Further knots go one by one into the stretch whose spans are widest.
  std::vector<std::size_t> spans(served + 1, 1);
  const auto width = [&](std::size_t i) { return (ends[i + 1] - ends[i]) / static_cast<double>(spans[i]); };
  for (std::size_t left = inner - served * each; left > 0; --left) {
    std::size_t widest = 0;
    for (std::size_t i = 1; i < spans.size(); ++i)
      if (width(i) > width(widest)) widest = i;
    ++spans[widest];
  }
  std::vector<double> knots(p + 1, 0.0);
  for (std::size_t i = 0; i < spans.size(); ++i) {
    for (std::size_t k = 1; k < spans[i]; ++k)
      knots.push_back(ends[i] +
                      (ends[i + 1] - ends[i]) * static_cast<double>(k) / static_cast<double>(spans[i]));
    if (i < served) knots.insert(knots.end(), each, ends[i + 1]);
  }
  knots.insert(knots.end(), p + 1, 1.0);
  return knots;
}

bool begins_smooth(const std::vector<CurvePoint>& curve) {
  constexpr double level = 1e-9;  // as flat as rounding leaves it
  return std::abs(curve.front().slope_z) <= level * std::abs(curve.front().slope_r);
}

std::vector<ControlPoint> fit_control_points(const std::vector<CurvePoint>& curve, int degree,
                                             const std::vector<double>& knots) {
  const auto points = static_cast<Eigen::Index>(knots.size()) - degree - 1;
  const auto rows = static_cast<Eigen::Index>(curve.size());
  CATOPTRIC_EXPECTS(points > degree && 2 * rows >= points);
  constexpr double slope_weight = 0.1, end_weight = 1e3;
  const double last = curve.back().angle_rad;
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(2 * rows, points);
  Eigen::VectorXd r(2 * rows), z(2 * rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const CurvePoint& at = curve[static_cast<std::size_t>(i)];
    const SplineBasis values = spline_basis(degree, knots, std::min(1.0, at.angle_rad / last));
    const double weight = i == 0 || i + 1 == rows ? end_weight : 1.0;
    for (std::size_t k = 0; k < values.value.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(values.first + k);
      basis(2 * i, column) = weight * values.value[k];
      basis(2 * i + 1, column) = slope_weight * values.slope[k];
    }
    r[2 * i] = weight * at.r_mm;
    z[2 * i] = weight * at.z_mm;
    r[2 * i + 1] = slope_weight * at.slope_r * last;
    z[2 * i + 1] = slope_weight * at.slope_z * last;
  }
  // r_0 = 0 drops its column; z_1 = z_0, where the curve crosses the axis smoothly, joins two.
  const Eigen::VectorXd solved_r = basis.rightCols(points - 1).colPivHouseholderQr().solve(r);
  const bool smooth = begins_smooth(curve);
  Eigen::MatrixXd joined = basis.rightCols(points - 1);
  joined.col(0) += basis.col(0);
  const Eigen::VectorXd solved_z = (smooth ? joined : basis).colPivHouseholderQr().solve(z);
  std::vector<ControlPoint> control{{0, solved_z[0], 1}};
  for (Eigen::Index i = 0; i + 1 < points; ++i)
    control.push_back({std::max(0.0, solved_r[i]), solved_z[smooth ? i : i + 1], 1});
  return control;
}

}  // namespace catoptric::design
