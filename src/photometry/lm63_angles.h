#pragma once

#include <string>
#include <vector>

#include "photometry/lm63.h"
#include "photometry/number_stream.h"

namespace catoptric::photometry {

/// Reads the vertical and the horizontal angles and holds them against the rules of the file's type.
/// @fails InputError
void read_lm63_angles(Lm63File& file, std::size_t vertical_count, std::size_t horizontal_count,
                      NumberStream& numbers, std::vector<std::string>& notes);

/// How the horizontal angles of type C stand for a full turn.
enum class PlaneSymmetry { rotational, quadrant, about_c0, about_c90, none_closed, none_open };

/// @in    horizontal_deg: ascending, as read_lm63_angles() accepts them for type C
PlaneSymmetry plane_symmetry(const std::vector<double>& horizontal_deg);

}  // namespace catoptric::photometry
