#pragma once

#include <optional>
#include <vector>

namespace catoptric::report {

/// Values at points of a plane, in any order.
struct ScatteredField {
  std::vector<double> x, y, value;
};

/// Values over a grid: value[j * x.size() + i] belongs to (x[i], y[j]); NaN where there is none. The axes
/// ascend.
struct GridField {
  std::vector<double> x, y, value;
  double at(std::size_t i, std::size_t j) const { return value[j * x.size() + i]; }
};

/// Checks the sizes and the order of a grid's axes.
/// @fails InputError
void require_sound(const GridField& field);

/// Scattered values brought onto a grid of square cells for a picture. Between samples the values are
/// weighted by nearness, on a sample its own value stands; cells without a sample nearby, or more than
/// a cell outside the disc, stay empty.
/// @in    cells along the longer side, at least 2; a disc about (0, 0) when the samples lie on one
/// @fails InputError when the lists differ in length or are empty
/// @error a picture's: it smooths over two sample distances, so nothing is measured on it
/// @cost  O(samples + cells^2)
/// @from  local inverse-distance weights: Franke & Nielson 1980, eq. 4
GridField gridded(const ScatteredField& field, int cells, std::optional<double> disc_radius = {});

/// The same surface by bilinear interpolation on `cells` + 1 equal steps along each axis, for a smooth
/// picture.
GridField refined(const GridField& field, int cells);

/// Bilinear value at a point within the grid (outside: at the nearest edge), NaN next to an empty cell.
double interpolated(const GridField& field, double x, double y);

}  // namespace catoptric::report
