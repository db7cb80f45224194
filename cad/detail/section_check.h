#pragma once

#include <vector>

#include "base/profile.h"
#include "cad/detail/wall_section.h"

namespace catoptric::cad::detail {

/// Refuses a parallel curve at signed distance `offset_mm` (to the left of the running curve) that folds or
/// leaves the half-plane r >= 0 within one span.
/// @fails CadError that says where
/// @error looks at 128 points a span; what slips through fails check_section_is_simple or the kernel's check
/// @from  do Carmo, Differential Geometry of Curves and Surfaces, section 1-5: speed of the parallel 1 - k d
void check_span_offset(const RationalSpan& span, double offset_mm);

/// Refuses a section whose outline (generatrix and wall) meets itself.
/// @fails CadError that says where
/// @error the outline as a polygon of 64 points a piece
void check_section_is_simple(const Profile& profile, const std::vector<SectionPiece>& pieces);

}  // namespace catoptric::cad::detail
