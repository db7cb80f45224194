#pragma once

#include <cstddef>
#include <vector>

#include "design/scene.h"
#include "design/settings.h"
#include "sim/near_field.h"

namespace catoptric::design {

/// A grid of a rectangle's cells, whose centres are measured.
struct MeasuringGrid {
  std::size_t columns, rows;
  double greatest_spacing_mm;  ///< p, which no spacing exceeds
};

/// The grid on which illuminance is to be measured and computed: p = 0.2 * 5^(log10 d), d the longer side in
/// m, or the shorter one where the ratio of the sides is 2 or more; p is at most 10 m. Of the whole numbers
/// of cells whose spacings do not exceed p the least are taken. A zone along walls, which the standard leaves
/// out, is the user's to take off the near field.
/// @fails InputError for more than a million points
/// @from  EN 12464-1, section on illuminance grids
MeasuringGrid en12464_grid(double width_mm, double height_mm);

/// Checks the keys of the near field's samples, and fills in their number where a grid gives it.
/// @in    settings whose near field is complete
/// @fails InputError for a grid on a disc, beside a table of points, or beside another number of samples
void complete_samples(Settings& settings);

/// Where the near field is looked at: the scene's grid or as many samples as it says, even by area.
std::vector<sim::FieldSample> field_samples(const Scene& scene);

/// Distance between neighbours along the near field's axes; of a disc's spiral, which has no rows, the root
/// of the area that a sample stands for.
struct Spacing {
  double first_mm, second_mm;
};
Spacing spacing(const Scene& scene);

}  // namespace catoptric::design
