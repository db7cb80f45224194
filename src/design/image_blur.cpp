#include "design/image_blur.h"

#include <algorithm>
#include <cmath>

#include "base/contract.h"
#include "base/units.h"

namespace catoptric::design {
namespace {

constexpr std::size_t rings = 200;

/// How much of a circle about the axis lies within a distance of a point.
double share_within(double circle_mm, double point_mm, double distance_mm) {
  if (circle_mm + point_mm <= distance_mm) return 1;
  if (std::abs(circle_mm - point_mm) >= distance_mm) return 0;
  const double cosine =
      (circle_mm * circle_mm + point_mm * point_mm - distance_mm * distance_mm) / (2 * circle_mm * point_mm);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) / pi;
}

}  // namespace

ImageBlur::ImageBlur(const std::vector<double>& radii_mm, double image_mm)
    : width_mm_((radii_mm.back() + image_mm) / rings),
      light_(static_cast<Eigen::Index>(radii_mm.size()), static_cast<Eigen::Index>(rings)) {
  CATOPTRIC_EXPECTS(image_mm > 0);
  for (std::size_t j = 0; j < rings; ++j) rings_mm_.push_back(width_mm_ * (static_cast<double>(j) + 0.5));
  for (std::size_t j = 0; j < rings; ++j)
    for (std::size_t i = 0; i < radii_mm.size(); ++i)
      light_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          share_within(rings_mm_[j], radii_mm[i], image_mm) / (pi * image_mm * image_mm);
}

std::vector<double> ImageBlur::densities(const Eigen::VectorXd& powers) const {
  std::vector<double> densities;
  for (std::size_t j = 0; j < rings; ++j)
    densities.push_back(powers[static_cast<Eigen::Index>(j)] / (2 * pi * rings_mm_[j] * width_mm_));
  return densities;
}

Eigen::VectorXd ImageBlur::even_powers(const Eigen::VectorXd& wanted) const {
  Eigen::VectorXd powers(static_cast<Eigen::Index>(rings));
  for (std::size_t j = 0; j < rings; ++j)
    powers[static_cast<Eigen::Index>(j)] = wanted.mean() * 2 * pi * rings_mm_[j] * width_mm_;
  return powers;
}

Eigen::VectorXd ImageBlur::factors(const Eigen::VectorXd& wanted, const Eigen::VectorXd& made) const {
  const Eigen::VectorXd asked = light_.transpose() * wanted, given = light_.transpose() * made;
  Eigen::VectorXd factors = Eigen::VectorXd::Ones(given.size());
  for (Eigen::Index j = 0; j < given.size(); ++j)
    if (given[j] > 0) factors[j] = std::max(0.0, asked[j]) / given[j];
  return factors;
}

Eigen::VectorXd ImageBlur::improved(const Eigen::VectorXd& wanted, Eigen::VectorXd powers, int rounds) const {
  for (int round = 0; round < rounds; ++round) powers.array() *= factors(wanted, light(powers)).array();
  return powers;
}

double ImageBlur::limit(const Eigen::VectorXd& wanted) const {
  constexpr int most_looks = 50, rounds_a_look = 100;
  constexpr double still = 1e-3;
  Eigen::VectorXd powers = even_powers(wanted);
  double last = HUGE_VAL;
  for (int look = 0; look < most_looks; ++look) {
    powers = improved(wanted, std::move(powers), rounds_a_look);
    const double now = std::sqrt((light(powers) - wanted).squaredNorm() / static_cast<double>(wanted.size()));
    if (now >= (1 - still) * last) return now;
    last = now;
  }
  return last;
}

}  // namespace catoptric::design
