#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/ray.h"
#include "design/settings.h"
#include "sim/near_field.h"

namespace catoptric::design {

/// Irradiance wanted as a picture shows it, laid on the near field's plane about its centre: columns along
/// the first axis, the first row at the greatest second coordinate.
struct Picture {
  std::size_t columns = 0, rows = 0;
  std::vector<double> irradiance_w_per_mm2;  ///< of the pixels' centres, row by row
  double width_mm = 0, height_mm = 0;        ///< from edge to edge

  /// Whether a place of the plane lies on the picture.
  bool covers(const Vector2& plane_mm) const;
  /// Bilinear between the pixels' centres, level in the outer half pixel, 0 beyond the edge.
  double at(const Vector2& plane_mm) const;
};

/// Fills in what follows from the picture's file: the side that is not given from the number of columns and
/// rows, how grey stands for light, and the irradiance of white where only the shape is wanted.
/// @in    target.kind = "image" with a file; its name becomes absolute
/// @fails InputError for a key that is missing or has no effect, or a file that cannot be read
void complete_picture(Settings& settings);

/// The picture with its irradiance.
/// @in    settings completed; notes: what is worth telling is added, in sentences
/// @fails InputError for a picture without light, or values out of range
Picture read_picture(const Settings& settings, double unit_mm, std::vector<std::string>& notes);

/// How far a picture on a near field across the z axis is from symmetric about it: the least relative root
/// mean square error that a field can have which depends on the distance from the axis alone, that of its
/// means over rings. Relative to the picture's root mean square, both over the near field.
/// @error of a sum over 256 to 1024 radii and 512 to 2048 directions, about one for each pixel
/// @cost  some 10 ms
double asymmetry_rel(const Picture& picture, const sim::NearField& field);

}  // namespace catoptric::design
