#include "design/direction_residuals.h"

#include <ceres/jet.h>

#include <cmath>

#include "base/contract.h"

namespace catoptric::design {
namespace {

/// A number with its derivatives by a curve point's r, z and their slopes by the parameter.
using Local = ceres::Jet<double, 4>;

/// A point of the generatrix, and what its slope is made of.
struct Place {
  double weight = 0, weight_slope = 0;
  double r = 0, z = 0, slope_r = 0, slope_z = 0;
};

Place place_of(const SplineBasis& basis, std::span<const ControlPoint> points) {
  Place place;
  double wr = 0, wz = 0, wr_slope = 0, wz_slope = 0;
  for (std::size_t i = 0; i < basis.value.size(); ++i) {
    const ControlPoint& point = points[basis.first + i];
    const double part = basis.value[i] * point.weight, slope = basis.slope[i] * point.weight;
    place.weight += part;
    place.weight_slope += slope;
    wr += part * point.r_mm;
    wz += part * point.z_mm;
    wr_slope += slope * point.r_mm;
    wz_slope += slope * point.z_mm;
  }
  place.r = wr / place.weight;
  place.z = wz / place.weight;
  place.slope_r = (wr_slope - place.r * place.weight_slope) / place.weight;
  place.slope_z = (wz_slope - place.z * place.weight_slope) / place.weight;
  return place;
}

/// The miss of one ray, as r and z of a difference of unit vectors.
struct Miss {
  Local r, z;
};

Miss miss_of(const Place& at, const FluxMap& map, const AxialLayout& layout, double side) {
  const Local r(at.r, 0), z(at.z, 1), slope_r(at.slope_r, 2), slope_z(at.slope_z, 3);
  const Local away_r = r, away_z = z - layout.source_z_mm;
  const Local distance = hypot(away_r, away_z);
  const Local ray_r = away_r / distance, ray_z = away_z / distance;
  const Local slope = hypot(slope_r, slope_z);
  const Local normal_r = -slope_z / slope, normal_z = slope_r / slope;
  const Local twice = 2.0 * (ray_r * normal_r + ray_z * normal_z);
  const Local angle = atan2(away_r, layout.apex_side * away_z);
  const Landing landing = map.at(angle.a);
  Local radius(side * landing.radius_mm);
  radius.v = side * landing.per_angle_mm * angle.v;
  const Local to_r = radius - r, to_z = layout.field_z_mm - z;
  const Local way = hypot(to_r, to_z);
  return {ray_r - twice * normal_r - to_r / way, ray_z - twice * normal_z - to_z / way};
}

}  // namespace

DirectionResiduals::DirectionResiduals(const FluxMap& map, const AxialLayout& layout, RayMap kind, int degree,
                                       std::vector<double> knots, std::size_t rays)
    : map_(map), layout_(layout), side_(kind == RayMap::crossing ? -1.0 : 1.0) {
  CATOPTRIC_EXPECTS(rays > 0);
  const double first = knots[static_cast<std::size_t>(degree)];
  const double last = knots[knots.size() - static_cast<std::size_t>(degree) - 1];
  for (std::size_t i = 0; i < rays; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(rays);
    rays_.push_back(spline_basis(degree, knots, first + (last - first) * share));
  }
}

void DirectionResiduals::evaluate(std::span<const ControlPoint> points, std::span<double> residuals,
                                  Eigen::MatrixXd* jacobian) const {
  CATOPTRIC_EXPECTS(residuals.size() == size());
  const double scale = 1 / std::sqrt(static_cast<double>(rays_.size()));
  if (jacobian)
    jacobian->setZero(static_cast<Eigen::Index>(size()), static_cast<Eigen::Index>(3 * points.size()));
  for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
    const SplineBasis& basis = rays_[ray];
    const Place at = place_of(basis, points);
    const Miss miss = miss_of(at, map_, layout_, side_);
    residuals[2 * ray] = scale * miss.r.a;
    residuals[2 * ray + 1] = scale * miss.z.a;
    if (!jacobian) continue;
    for (std::size_t i = 0; i < basis.value.size(); ++i) {
      const ControlPoint& point = points[basis.first + i];
      // A pole moves the curve by its share of the weight; a weight draws the curve towards its pole.
      const double share = basis.value[i] / at.weight;
      const double share_slope = (basis.slope[i] - share * at.weight_slope) / at.weight;
      const auto column = static_cast<Eigen::Index>(3 * (basis.first + i));
      for (int part = 0; part < 2; ++part) {
        const auto& by = part == 0 ? miss.r.v : miss.z.v;
        const auto row = static_cast<Eigen::Index>(2 * ray) + part;
        (*jacobian)(row, column) = scale * point.weight * (by[0] * share + by[2] * share_slope);
        (*jacobian)(row, column + 1) = scale * point.weight * (by[1] * share + by[3] * share_slope);
        (*jacobian)(row, column + 2) =
            scale * (by[0] * share * (point.r_mm - at.r) + by[1] * share * (point.z_mm - at.z) +
                     by[2] * (share_slope * (point.r_mm - at.r) - share * at.slope_r) +
                     by[3] * (share_slope * (point.z_mm - at.z) - share * at.slope_z));
      }
    }
  }
}

}  // namespace catoptric::design
