#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/kernel_sum.h"
#include "sim/ladder_sum.h"
#include "sim/stored_photons.h"

namespace catoptric::sim {

/// Photons of a part of a plane, sorted into the cells of a grid over the rectangle that holds them: some
/// photons a cell, rows one after the other, so that what a circle cuts out of a row is one stretch of
/// memory.
///
/// A cell may hold many photons where they crowd. Points spread evenly over the plane meet such a cell as
/// rarely as it is small for its photons, so that all of them together cost what evenly spread photons cost.
class PhotonGrid {
 public:
  /// Takes the photons over, stretch after stretch, and frees each. In a cell they keep their order.
  /// @cost  O(photons), 16 bytes a photon and 4 a cell
  PhotonGrid() = default;
  explicit PhotonGrid(std::vector<std::vector<StoredPhoton>*> stretches);

  std::size_t size() const { return size_; }

  /// Adds the photons within the kernel's radius to the sum.
  void add_within(const StoredPhoton& centre, double radius_mm, KernelSum& sum) const;

  /// The same for the kernels of a ladder of radii.
  void add_within(const StoredPhoton& centre, double widest_radius_mm, LadderSum& sum) const;

  /// Photons in cells that lie wholly within the radius; never more than lie within it.
  std::size_t surely_within(const StoredPhoton& centre, double radius_mm) const;

  /// Hands over every so-manieth photon, in the order of the cells.
  /// @in at least 1
  template <typename Take>
  void take_every(std::size_t stride, const Take& take) const {
    for (std::size_t i = stride / 2; i < size_; i += stride) take(StoredPhoton{x_[i], y_[i]});
  }

  /// Appends the squared distances of the photons within the radius, border included.
  void append_squares(const StoredPhoton& centre, double radius_mm, std::vector<double>& squares_mm2) const;

 private:
  struct Row {
    double nearest_mm, farthest_mm;  ///< distances from a height to the row
  };
  struct Axis {
    double first = 0, per_mm = 1, cell_mm = 0;  ///< one cell: any per_mm > 0 serves (0 * infinity is none)
    std::size_t cells = 1;
    std::size_t cell_of(double at) const;
  };
  static Axis axis_over(double low, double high, double cell_mm);
  void measure(const std::vector<std::vector<StoredPhoton>*>& stretches);
  void sort(std::vector<std::vector<StoredPhoton>*>& stretches);
  Row row_from(double y_mm, std::size_t row) const;
  template <typename Take>
  void for_each_stretch(const StoredPhoton& centre, double radius_mm, const Take& take) const;

  std::size_t size_ = 0;
  Axis across_, up_;
  double right_ = 0, top_ = 0;
  double slack_mm_ = 0;                ///< what rounding may shift a row's border by
  std::vector<std::uint32_t> starts_;  ///< first photon of each cell, and their number
  std::vector<double> x_, y_;
};

}  // namespace catoptric::sim
