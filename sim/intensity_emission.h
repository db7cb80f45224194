#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/intensity_table.h"
#include "sim/projection_map.h"
#include "sim/source.h"

namespace catoptric::sim {

/// Photons from a point whose intensity is a table's, into the cells of the table that touch some directions.
///
/// Rows of gamma, in each the cells of C: a first number picks the row by its light, a second the cell within
/// it; what is left of both picks the direction within the cell, whose bilinear intensity is followed
/// exactly: the sine-weighted line in gamma is inverted by Newton's steps, the line in C in closed form. So
/// both numbers are used without rejection, and evenly spread ones stay even.
class IntensityEmission final : public Emission {
 public:
  /// @in    frame: columns are the directions C = 0, C = 90 and gamma = 0; towards: directions in the frame
  /// of
  ///        the scene that must not be left out, all of them where there is none; power_w: of all of the
  ///        table
  /// @cost  some ms
  IntensityEmission(const Vector3& position_mm, const Eigen::Matrix3d& frame, const IntensityTable& table,
                    const ProjectionMap* towards, double power_w);
  double power_w() const override { return power_w_; }
  std::size_t numbers() const override { return 2; }
  Ray emit(const std::array<double, 4>& numbers, std::uint64_t stream) const override;

 private:
  /// A piece of the table between two angles of each kind; intensities at its corners.
  struct Cell {
    double first_c_rad, width_c_rad;
    double low_first, low_last, high_first, high_last;  ///< low and high gamma, first and last C
    double before;                                      ///< light of the row's cells before it
  };
  struct Row {
    double low_rad, high_rad;
    std::vector<Cell> cells;
    double light = 0, before = 0;  ///< of its cells, of the rows before it
  };
  void add_row(const IntensityTable& table, double low_deg, double high_deg, const ProjectionMap* towards);

  Vector3 position_mm_;
  Eigen::Matrix3d frame_;
  std::vector<Row> rows_;
  double light_ = 0, power_w_;
};

}  // namespace catoptric::sim
