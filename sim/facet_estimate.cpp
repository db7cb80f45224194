#include "sim/facet_estimate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nanoflann.hpp>
#include <utility>

#include "base/tolerance.h"
#include "base/units.h"
#include "sim/side_by_side.h"

namespace catoptric::sim {
namespace {

constexpr double least_cosine = 0.5;  // 60 degrees

/// Adds the kernel over a triangle, halved at its longest side until it is small beside the kernel.
class TriangleIntegral {
 public:
  TriangleIntegral(const Vector3& centre_mm, Kernel kernel, double radius_mm)
      : centre_mm_(centre_mm), kernel_(kernel), radius_mm_(radius_mm) {}

  void add(const Vector3& a, const Vector3& b, const Vector3& c) {
    const std::array corners{a, b, c};
    std::array<double, 3> squares;  // of the side opposite each corner
    for (std::size_t i = 0; i < 3; ++i)
      squares[i] = (corners[(i + 2) % 3] - corners[(i + 1) % 3]).squaredNorm();
    const std::size_t top = static_cast<std::size_t>(std::ranges::max_element(squares) - squares.begin());
    const double longest_mm = std::sqrt(squares[top]);
    const Vector3 middle = (a + b + c) / 3;
    const double away_mm = (middle - centre_mm_).norm();
    if (away_mm > radius_mm_ + longest_mm) return;  // no corner is farther from the middle than that
    constexpr double fine = 0.125;
    if (longest_mm > fine * radius_mm_) {
      const Vector3 &left = corners[(top + 1) % 3], &right = corners[(top + 2) % 3];
      const Vector3 half = 0.5 * (left + right);
      add(corners[top], left, half);
      add(corners[top], half, right);
      return;
    }
    // Exact for quadratics: the middles of the sides.
    double mean = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 at = 0.5 * (corners[i] + corners[(i + 1) % 3]);
      mean += kernel_value(kernel_, (at - centre_mm_).norm() / radius_mm_) / 3;
    }
    sum_mm2_ += mean * 0.5 * (b - a).cross(c - a).norm();
  }

  double mm2() const { return sum_mm2_; }

 private:
  Vector3 centre_mm_;
  Kernel kernel_;
  double radius_mm_;
  double sum_mm2_ = 0;
};

/// Photons as nanoflann wants to see them.
struct PhotonCloud {
  std::vector<Vector3> points_mm;
  std::vector<std::uint32_t> facets;

  std::size_t kdtree_get_point_count() const { return points_mm.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points_mm[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using PhotonTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PhotonCloud>, PhotonCloud, 3>;

PhotonCloud cloud_of(const FacetField& field, const TracedPhotons& landed) {
  PhotonCloud cloud;
  for (const StoredChunk& chunk : landed.chunks)
    for (const auto& band : chunk.front)
      for (const StoredPhoton& photon : band) {
        cloud.points_mm.push_back(field.to_space({photon.x_mm, photon.y_mm}));
        cloud.facets.push_back(static_cast<std::uint32_t>(field.facet_at({photon.x_mm, photon.y_mm})));
      }
  return cloud;
}

/// Squares of distances of the photons that count at a sample.
class Gatherer {
 public:
  Gatherer(const FacetField& field, const PhotonCloud& cloud)
      : field_(field), cloud_(cloud), tree_(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}

  /// Those within the radius.
  void within(const FieldSample& sample, double radius_mm, std::vector<double>& squares) const {
    std::vector<Match> matches;
    nanoflann::SearchParams unsorted;
    unsorted.sorted = false;
    tree_.radiusSearch(sample.point_mm.data(), radius_mm * radius_mm, matches, unsorted);
    keep(sample, matches, squares);
  }

  /// The nearest `count`, or all that are.
  void nearest(const FieldSample& sample, std::size_t count, std::vector<double>& squares) const {
    for (std::size_t asked = count;; asked *= 2) {
      std::vector<std::uint32_t> places(std::min(asked, cloud_.points_mm.size()));
      std::vector<double> found(places.size());
      std::vector<Match> matches;
      const std::size_t n = places.empty() ? 0
                                           : tree_.knnSearch(sample.point_mm.data(), places.size(),
                                                             places.data(), found.data());
      for (std::size_t i = 0; i < n; ++i) matches.emplace_back(places[i], found[i]);
      keep(sample, matches, squares);
      if (squares.size() >= count || asked >= cloud_.points_mm.size()) break;
    }
    if (squares.size() > count) squares.resize(count);  // they come nearest first
  }

 private:
  using Match = std::pair<std::uint32_t, double>;

  void keep(const FieldSample& sample, const std::vector<Match>& matches,
            std::vector<double>& squares) const {
    squares.clear();
    for (const auto& [place, square] : matches)
      if (field_.lit_normal(cloud_.facets[place]).dot(sample.normal) > least_cosine)
        squares.push_back(square);
  }

  const FacetField& field_;
  const PhotonCloud& cloud_;
  PhotonTree tree_;
};

}  // namespace

double kernel_integral_mm2(const FacetField& field, const Vector3& point_mm, const Vector3& normal,
                           Kernel kernel, double radius_mm) {
  TriangleIntegral integral(point_mm, kernel, radius_mm);
  for (std::size_t i = 0; i < field.facets(); ++i)
    if (field.lit_normal(i).dot(normal) > least_cosine)
      integral.add(field.corner_mm(i, 0), field.corner_mm(i, 1), field.corner_mm(i, 2));
  return integral.mm2();
}

MapEstimate estimate_on_facets(const FacetField& field, const TracedPhotons& landed,
                               std::span<const FieldSample> samples, const EstimateOptions& options) {
  check(options);
  MapEstimate out{std::vector<double>(samples.size()), std::vector<double>(samples.size()),
                  std::vector<double>(samples.size()), std::vector<std::size_t>(samples.size())};
  const PhotonCloud cloud = cloud_of(field, landed);
  const Gatherer photons(field, cloud);
  const double least_radius_mm = Tolerance::for_scale(std::sqrt(field.area_mm2())).length_mm;
  const auto estimate_one = [&](std::size_t i, std::vector<double>& squares) {
    double radius_mm = options.kernel_radius_mm.value_or(0);
    if (options.kernel_radius_mm) {
      photons.within(samples[i], radius_mm, squares);
    } else {
      photons.nearest(samples[i], *options.neighbours, squares);
      if (!squares.empty())
        radius_mm = std::max(least_radius_mm, std::sqrt(*std::ranges::max_element(squares)));
    }
    out.kernel_radius_mm[i] = radius_mm;
    out.photons[i] = squares.size();
    if (squares.empty()) return;
    double sum = 0, sum_of_squares = 0;
    for (const double square : squares) {
      const double weight = kernel_value(options.kernel, std::sqrt(square) / radius_mm);
      sum += weight;
      sum_of_squares += weight * weight;
    }
    const double scale =
        landed.photon_power_w /
        kernel_integral_mm2(field, samples[i].point_mm, samples[i].normal, options.kernel, radius_mm);
    out.irradiance[i] = scale * sum;
    out.noise[i] = scale * std::sqrt(sum_of_squares);
  };
  constexpr std::size_t chunk = 16;
  side_by_side((samples.size() + chunk - 1) / chunk, [&](std::size_t part) {
    std::vector<double> squares;
    for (std::size_t i = part * chunk; i < std::min(samples.size(), (part + 1) * chunk); ++i)
      estimate_one(i, squares);
  });
  return out;
}

}  // namespace catoptric::sim
