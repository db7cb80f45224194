#include "sim/photon_map.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

#include "base/contract.h"
#include "base/tolerance.h"
#include "base/units.h"
#include "sim/edge_correction.h"
#include "sim/kernel_shape.h"

namespace catoptric::sim {
namespace {

/// Points as the tree library wants to see them.
struct PointCloud {
  std::vector<std::array<double, 2>> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const { return points[index][axis]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<
    nanoflann::L2_Simple_Adaptor<double, PointCloud, double, std::uint32_t>, PointCloud, 2, std::uint32_t>;

/// Squared distances within a fixed radius. (All distances of the tree library are squares.)
class WithinRadius {
 public:
  WithinRadius(double radius_mm, std::vector<double>& squares)
      : square_(radius_mm * radius_mm), squares_(squares) {
    squares_.clear();
  }
  bool addPoint(double square, std::uint32_t) {
    squares_.push_back(square);
    return true;
  }
  double worstDist() const { return square_; }
  bool full() const { return true; }
  std::size_t size() const { return squares_.size(); }

 private:
  double square_;
  std::vector<double>& squares_;
};

/// Squared distances of the nearest N: up to 2 N candidates are collected, then the farther half is dropped,
/// a constant number of steps a candidate. (The library's own result set keeps a sorted list, N moves a
/// candidate; a heap takes log N and is half as fast as this.) Equal distances cannot make a difference,
/// since all photons weigh the same.
class Nearest {
 public:
  Nearest(std::size_t count, std::vector<double>& squares) : count_(count), squares_(squares) {
    squares_.clear();
    squares_.reserve(2 * count);
  }
  bool addPoint(double square, std::uint32_t) {
    if (!(square < worst_)) return true;
    squares_.push_back(square);
    if (squares_.size() == 2 * count_) keep_nearest();
    return true;
  }
  double worstDist() const { return worst_; }
  bool full() const { return true; }
  std::size_t size() const { return squares_.size(); }

  void keep_nearest() {
    if (squares_.size() < count_) return;
    const auto farthest = squares_.begin() + static_cast<std::ptrdiff_t>(count_ - 1);
    std::nth_element(squares_.begin(), farthest, squares_.end());
    worst_ = *farthest;
    squares_.resize(count_);
  }

 private:
  std::size_t count_;
  std::vector<double>& squares_;
  double worst_ = std::numeric_limits<double>::max();
};

/// The photons of one side of the plane.
class Side {
 public:
  explicit Side(std::vector<std::array<double, 2>> points)
      : cloud_{std::move(points)}, tree_(2, cloud_, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size)) {
    // The leaves refer to stretches of an index list; with the points themselves in that order a leaf is one
    // stretch of memory. The tree is built by one thread, so its order, and with it the order of every sum,
    // depends on the photons alone.
    std::vector<std::array<double, 2>> ordered(cloud_.points.size());
    for (std::size_t i = 0; i < ordered.size(); ++i) {
      ordered[i] = cloud_.points[tree_.vAcc[i]];
      tree_.vAcc[i] = static_cast<std::uint32_t>(i);
    }
    cloud_.points = std::move(ordered);
  }
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;

  std::size_t size() const { return cloud_.points.size(); }

  template <typename ResultSet>
  void search(const Vector2& plane_mm, ResultSet&& result) const {
    if (size() == 0) return;
    tree_.findNeighbors(result, plane_mm.data(), nanoflann::SearchParams());
  }

 private:
  static constexpr std::size_t leaf_size = 16;
  PointCloud cloud_;
  Tree tree_;
};

struct Sums {
  double weight = 0, weight_squared = 0;
};

Sums kernel_sums(Kernel kernel, const std::vector<double>& squares, double radius_mm) {
  return with_kernel(kernel, [&]<Kernel k>() {
    const double scale = 1 / (radius_mm * radius_mm);
    Sums sums;
    for (double square : squares) {
      const double weight = kernel_of_square<k>(std::min(1.0, square * scale));
      sums.weight += weight;
      sums.weight_squared += weight * weight;
    }
    return sums;
  });
}

}  // namespace

void check(const EstimateOptions& options) {
  if (options.neighbours.has_value() == options.kernel_radius_mm.has_value())
    throw InputError({options.neighbours ? "both neighbours and kernel radius are set"
                                         : "neither neighbours nor kernel radius is set",
                      "estimate", "exactly one of them sets the bandwidth", "leave one of them out"});
  if (options.neighbours && *options.neighbours == 0)
    throw InputError({"0 neighbours", "estimate", "an estimate needs at least one photon", "500 is usual"});
  if (options.kernel_radius_mm &&
      !(std::isfinite(*options.kernel_radius_mm) && *options.kernel_radius_mm > 0))
    throw InputError({fmt::format("kernel radius of {} mm", *options.kernel_radius_mm), "estimate",
                      "a radius is finite and greater than 0", "a tenth of the field's size is usual"});
}

double recording_margin_mm(const NearField& field, const EstimateOptions& options) {
  return options.kernel_radius_mm ? *options.kernel_radius_mm
                                  : std::max(field.half_width_mm(), field.half_height_mm());
}

struct PhotonMap::Parts {
  NearField field;
  RecordedArea area;
  double photon_power_w;
  double least_radius_mm;  ///< a bandwidth below this would be a division by nothing
  Side front, back;

  const Side& side_of(const Vector3& normal) const { return normal.dot(field.normal()) > 0 ? front : back; }

  /// Fills `squares` and gives the bandwidth.
  double gather(const Side& side, const Vector2& at, const EstimateOptions& options,
                std::vector<double>& squares) const {
    if (options.kernel_radius_mm) {
      side.search(at, WithinRadius(*options.kernel_radius_mm, squares));
      return *options.kernel_radius_mm;
    }
    squares.clear();
    if (side.size() == 0) return 0;
    Nearest nearest(std::min(*options.neighbours, side.size()), squares);
    side.search(at, nearest);
    nearest.keep_nearest();
    return std::max(least_radius_mm, std::sqrt(*std::max_element(squares.begin(), squares.end())));
  }
};

namespace {

std::vector<std::array<double, 2>> points_from(const TracedPhotons& traced, bool front) {
  std::vector<std::array<double, 2>> points;
  for (const Crossing& crossing : traced.crossings)
    if (crossing.from_front() == front) points.push_back({crossing.x_mm, crossing.y_mm});
  return points;
}

}  // namespace

PhotonMap::PhotonMap(const NearField& field, const TracedPhotons& traced)
    : parts_(
          new Parts{field, traced.area, traced.photon_power_w,
                    Tolerance::for_scale(std::hypot(field.half_width_mm(), field.half_height_mm())).length_mm,
                    Side(points_from(traced, true)), Side(points_from(traced, false))}) {}
PhotonMap::~PhotonMap() = default;
PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap& PhotonMap::operator=(PhotonMap&&) noexcept = default;

std::size_t PhotonMap::size(const Vector3& normal) const { return parts_->side_of(normal).size(); }

MapEstimate PhotonMap::estimate(std::span<const FieldSample> samples, const EstimateOptions& options) const {
  check(options);
  MapEstimate out{std::vector<double>(samples.size()), std::vector<double>(samples.size()),
                  std::vector<double>(samples.size()), std::vector<std::size_t>(samples.size())};
  const auto estimate_one = [&](std::size_t i, std::vector<double>& squares) {
    const Vector2 at = parts_->field.to_plane(samples[i].point_mm);
    const double radius = parts_->gather(parts_->side_of(samples[i].normal), at, options, squares);
    out.kernel_radius_mm[i] = radius;
    out.photons[i] = squares.size();
    if (squares.empty()) return;
    const Sums sums = kernel_sums(options.kernel, squares, radius);
    const double scale = parts_->photon_power_w / (pi * radius * radius) /
                         kernel_mass_inside(options.kernel, radius, parts_->area, at);
    out.irradiance[i] = scale * sums.weight;
    out.noise[i] = scale * std::sqrt(sums.weight_squared);
  };
  constexpr std::size_t chunk = 16;
  tbb::parallel_for(std::size_t{0}, (samples.size() + chunk - 1) / chunk, [&](std::size_t part) {
    std::vector<double> squares;
    for (std::size_t i = part * chunk; i < std::min(samples.size(), (part + 1) * chunk); ++i)
      estimate_one(i, squares);
  });
  return out;
}

}  // namespace catoptric::sim
