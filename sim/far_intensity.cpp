#include "sim/far_intensity.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>

#include "base/contract.h"
#include "base/profile.h"
#include "base/tolerance.h"
#include "base/units.h"

namespace catoptric::sim {
namespace {

constexpr double rad_of_a_degree = pi / 180;

/// Weights are whole numbers of these, so that their sum does not depend on its order.
constexpr double unit_weight = 0x1p-32;

/// Integral of sin(gamma) times the share of the way from a to b, or from b to a: what a node at b, or at a,
/// has of a cell.
double half_hat(double a, double b, bool rising) {
  const double width = b - a;
  const double whole = 2 * std::sin(0.5 * (a + b)) * std::sin(0.5 * width);
  // Of (gamma - a) sin(gamma), by parts.
  const double risen = (std::sin(b) - std::sin(a) - width * std::cos(b)) / width;
  return rising ? risen : whole - risen;
}

/// A place between two nodes.
struct Between {
  std::size_t low, high;
  double share;  ///< of the way from low to high
};

class Nodes {
 public:
  explicit Nodes(const IntensityGrid& grid) : gamma_(grid.gamma_deg), c_(grid.c_deg) {
    CATOPTRIC_EXPECTS(gamma_.size() > 1 && !c_.empty());
    for (double& angle : gamma_) angle *= rad_of_a_degree;
    for (double& angle : c_) angle *= rad_of_a_degree;
  }
  std::size_t count() const { return gamma_.size() * c_.size(); }
  std::size_t index(std::size_t plane, std::size_t i) const { return plane * gamma_.size() + i; }

  Between gamma(const Vector3& local) const {
    const double angle = std::atan2(std::hypot(local.x(), local.y()), local.z());
    const auto after = std::upper_bound(gamma_.begin() + 1, gamma_.end() - 1, angle);
    const auto high = static_cast<std::size_t>(after - gamma_.begin());
    const double share = (angle - gamma_[high - 1]) / (gamma_[high] - gamma_[high - 1]);
    return {high - 1, high, std::clamp(share, 0.0, 1.0)};
  }

  Between c(const Vector3& local) const {
    if (c_.size() == 1) return {0, 0, 0};
    double angle = std::atan2(local.y(), local.x());
    if (angle < 0) angle += 2 * pi;
    const auto after = std::upper_bound(c_.begin() + 1, c_.end(), angle);
    const auto high = static_cast<std::size_t>(after - c_.begin());
    const double to = high < c_.size() ? c_[high] : 2 * pi;
    return {high - 1, high % c_.size(), std::clamp((angle - c_[high - 1]) / (to - c_[high - 1]), 0.0, 1.0)};
  }

  /// Solid angle that counts for a node: the integral of its hat.
  double solid_angle_sr(std::size_t plane, std::size_t i) const { return gamma_weight(i) * c_weight(plane); }

  double gamma_weight(std::size_t i) const {
    double sum = 0;
    if (i > 0) sum += half_hat(gamma_[i - 1], gamma_[i], true);
    if (i + 1 < gamma_.size()) sum += half_hat(gamma_[i], gamma_[i + 1], false);
    return sum;
  }

 private:
  double c_weight(std::size_t plane) const {
    if (c_.size() == 1) return 2 * pi;
    const double before = plane > 0 ? c_[plane] - c_[plane - 1] : 2 * pi - c_.back();
    const double after = plane + 1 < c_.size() ? c_[plane + 1] - c_[plane] : 2 * pi - c_.back();
    return 0.5 * (before + after);
  }

  std::vector<double> gamma_, c_;  ///< rad
};

/// Sums of weights that any thread may add to, in any order.
class SharedSums {
 public:
  explicit SharedSums(std::size_t count) : sums_(count, 0) {}
  void add(const std::vector<std::uint64_t>& part) {
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += part[i];
  }
  double weight(std::size_t i) const { return static_cast<double>(sums_[i]) * unit_weight; }

 private:
  std::mutex mutex_;
  std::vector<std::uint64_t> sums_;
};

std::vector<double> even_angles(double step_deg, double end_deg) {
  const int steps = std::max(1, static_cast<int>(std::ceil(end_deg / step_deg * (1 - 1e-12))));
  std::vector<double> angles;
  for (int i = 0; i <= steps; ++i) angles.push_back(end_deg * i / steps);
  return angles;
}

}  // namespace

IntensityGrid even_grid(double gamma_step_deg, double c_step_deg, const Eigen::Matrix3d& frame) {
  IntensityGrid grid{even_angles(gamma_step_deg, 180), {0}, frame};
  if (c_step_deg > 0) {
    grid.c_deg = even_angles(c_step_deg, 360);
    grid.c_deg.pop_back();
  }
  return grid;
}

FarIntensity far_intensity(const Scene& scene, const IntensityGrid& grid, const PhotonOptions& photons) {
  const Nodes nodes(grid);
  SharedSums sums(nodes.count());
  std::atomic<std::uint64_t> departed = 0;
  FarIntensity result;
  result.totals = depart(scene, photons, [&](std::uint64_t, std::span<const Ray> rays) {
    std::vector<std::uint64_t> part(nodes.count(), 0);
    const auto add = [&](std::size_t plane, std::size_t i, double weight) {
      part[nodes.index(plane, i)] += static_cast<std::uint64_t>(weight / unit_weight + 0.5);
    };
    for (const Ray& ray : rays) {
      const Vector3 local = grid.frame.transpose() * ray.direction;
      const Between gamma = nodes.gamma(local), c = nodes.c(local);
      add(c.low, gamma.low, (1 - c.share) * (1 - gamma.share));
      add(c.low, gamma.high, (1 - c.share) * gamma.share);
      add(c.high, gamma.low, c.share * (1 - gamma.share));
      add(c.high, gamma.high, c.share * gamma.share);
    }
    sums.add(part);
    departed += rays.size();
  });
  const double power_w = result.totals.photon_power_w;
  result.departed_w = power_w * static_cast<double>(departed.load());
  for (std::size_t plane = 0; plane < grid.c_deg.size(); ++plane)
    for (std::size_t i = 0; i < grid.gamma_deg.size(); ++i)
      result.w_per_sr.push_back(power_w * sums.weight(nodes.index(plane, i)) /
                                nodes.solid_angle_sr(plane, i));
  // On the axis all planes are one direction.
  for (const std::size_t pole : {std::size_t{0}, grid.gamma_deg.size() - 1}) {
    double flux = 0, solid = 0;
    for (std::size_t plane = 0; plane < grid.c_deg.size(); ++plane) {
      flux += result.w_per_sr[nodes.index(plane, pole)] * nodes.solid_angle_sr(plane, pole);
      solid += nodes.solid_angle_sr(plane, pole);
    }
    for (std::size_t plane = 0; plane < grid.c_deg.size(); ++plane)
      result.w_per_sr[nodes.index(plane, pole)] = flux / solid;
  }
  return result;
}

std::vector<double> step_bias(const IntensityGrid& grid, const std::vector<double>& w_per_sr) {
  const Nodes nodes(grid);
  const std::size_t rows = grid.gamma_deg.size();
  std::vector<double> bias(w_per_sr.size(), 0);
  for (std::size_t plane = 0; plane < grid.c_deg.size(); ++plane)
    for (std::size_t i = 0; i < rows; ++i) {
      // A hat of twice the width is the three hats in it, the outer two by half.
      double flux = 0, solid = 0;
      const auto count = [&](std::size_t at, double share) {
        flux += share * nodes.gamma_weight(at) * w_per_sr[nodes.index(plane, at)];
        solid += share * nodes.gamma_weight(at);
      };
      if (i > 0) count(i - 1, 0.5);
      count(i, 1);
      if (i + 1 < rows) count(i + 1, 0.5);
      bias[nodes.index(plane, i)] = (flux / solid - w_per_sr[nodes.index(plane, i)]) / 3;
    }
  return bias;
}

bool shines_round(const Scene& scene) {
  const Vector3& at_mm = scene.source.position_mm();
  const Tolerance tolerance = Tolerance::for_scale(scene.reflector.profile().diagonal_mm());
  return scene.source.is_round() && scene.source.tilt_rad() <= tolerance.angle_rad &&
         std::hypot(at_mm.x(), at_mm.y()) <= tolerance.length_mm;
}

}  // namespace catoptric::sim
