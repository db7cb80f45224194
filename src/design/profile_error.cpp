#include "design/profile_error.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "cad/refine.h"

namespace catoptric::design {
namespace {

using Index = std::size_t;

constexpr int least_degree = 3;  ///< so that the displaced curve bends smoothly
constexpr int new_spans = 30;

/// The curve with knots at equal arc lengths, so that it can bend alike everywhere.
Profile evenly_knotted(const Profile& base) {
  const Profile smooth = cad::elevated(base, std::max(base.degree(), least_degree));
  constexpr int steps = 100 * new_spans;
  const double first = smooth.first_parameter(), range = smooth.last_parameter() - first;
  std::vector<double> lengths{0};  // the knots need not be exact
  for (int i = 0; i < steps; ++i) {
    const MeridianPoint p = smooth.at(first + range * (i + 0.5) / steps);
    lengths.push_back(lengths.back() + std::hypot(p.dr, p.dz));
  }
  std::vector<double> knots;
  for (int i = 1; i < new_spans; ++i) {
    const auto place = std::upper_bound(lengths.begin(), lengths.end(), lengths.back() * i / new_spans);
    const double knot = first + range * static_cast<double>(place - lengths.begin()) / steps;
    const bool apart = std::none_of(smooth.knots().begin(), smooth.knots().end(),
                                    [&](double other) { return std::abs(other - knot) < range / steps; });
    if (apart && (knots.empty() || knot > knots.back())) knots.push_back(knot);
  }
  return cad::with_knots(smooth, knots);
}

/// Means of `degree` knots: where a spline's control points act.
std::vector<double> greville_parameters(const Profile& profile) {
  std::vector<double> nodes;
  for (Index i = 0; i < profile.points().size(); ++i) {
    double sum = 0;
    for (int k = 1; k <= profile.degree(); ++k) sum += profile.knots()[i + static_cast<Index>(k)];
    nodes.push_back(std::clamp(sum / profile.degree(), profile.first_parameter(), profile.last_parameter()));
  }
  return nodes;
}

/// Length from a to b, where the curve is smooth.
double arc_length_mm(const Profile& profile, double a, double b) {
  constexpr std::array<double, 3> node{-0.7745966692414834, 0.0, 0.7745966692414834};
  constexpr std::array<double, 3> weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
  double sum = 0;
  for (Index i = 0; i < node.size(); ++i) {
    const MeridianPoint p = profile.at(0.5 * (a + b) + 0.5 * (b - a) * node[i]);
    sum += weight[i] * std::hypot(p.dr, p.dz);
  }
  return 0.5 * (b - a) * sum;
}

/// The B-splines that a clamped curve's control points are weighted with at u.
/// @from  The NURBS Book, 2nd ed., eq. 2.5
std::vector<double> basis(const Profile& profile, double u) {
  const std::vector<double>& knots = profile.knots();
  const Index p = static_cast<Index>(profile.degree()), count = profile.points().size();
  Index span = p;
  while (span + 1 < count && u >= knots[span + 1]) ++span;
  std::vector<double> values(count + p, 0.0);
  values[span] = 1;
  for (Index degree = 1; degree <= p; ++degree)
    for (Index i = span - degree; i <= span; ++i) {
      const double rise = knots[i + degree] - knots[i], fall = knots[i + degree + 1] - knots[i + 1];
      const double left = rise > 0 ? (u - knots[i]) / rise * values[i] : 0;
      const double right = fall > 0 ? (knots[i + degree + 1] - u) / fall * values[i + 1] : 0;
      values[i] = left + right;
    }
  values.resize(count);
  double sum = 0;
  for (Index i = 0; i < count; ++i) sum += values[i] *= profile.points()[i].weight;
  for (double& value : values) value /= sum;
  return values;
}

}  // namespace

ProfileError::ProfileError(const Profile& base)
    : base_(evenly_knotted(base)), nodes_(greville_parameters(base_)) {
  double at = base_.first_parameter();
  std::vector<double> lengths;
  for (const double node : nodes_) {
    length_mm_ += arc_length_mm(base_, at, node);
    lengths.push_back(length_mm_);
    at = node;
  }
  for (const double length : lengths) shares_.push_back(length / length_mm_);
}

std::vector<PointShift> ProfileError::along_normal(const std::function<double(double)>& offset) const {
  const auto count = static_cast<Eigen::Index>(nodes_.size());
  Eigen::MatrixXd system(count, count), wanted(count, 2);
  for (Index i = 0; i < nodes_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const std::vector<double> values = basis(base_, nodes_[i]);
    for (Index j = 0; j < values.size(); ++j) system(row, static_cast<Eigen::Index>(j)) = values[j];
    const MeridianPoint p = base_.at(nodes_[i]);
    const double speed = std::hypot(p.dr, p.dz), size = offset(shares_[i]);
    wanted(row, 0) = speed > 0 ? -size * p.dz / speed : 0;
    wanted(row, 1) = speed > 0 ? size * p.dr / speed : size;
  }
  const Eigen::MatrixXd solved = system.partialPivLu().solve(wanted);
  std::vector<PointShift> shift;
  for (Eigen::Index i = 0; i < count; ++i) shift.push_back({solved(i, 0), solved(i, 1)});
  if (base_.points().front().r_mm == 0) shift.front().dr_mm = 0;
  return shift;
}

std::optional<Profile> ProfileError::at(const std::vector<PointShift>& shift, double amplitude) const {
  std::vector<ControlPoint> points = base_.points();
  for (Index i = 0; i < points.size(); ++i) {
    points[i].r_mm += amplitude * shift[i].dr_mm;
    points[i].z_mm += amplitude * shift[i].dz_mm;
  }
  if (Profile::find_defect(base_.degree(), base_.knots(), points)) return std::nullopt;
  return Profile(base_.degree(), base_.knots(), std::move(points));
}

}  // namespace catoptric::design
