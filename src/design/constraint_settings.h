#pragma once

#include "design/constraints.h"
#include "design/settings.h"
#include "sim/near_field.h"

namespace catoptric::design {

/// The scene's constraints, in mm and rad.
/// @fails InputError for limits that exclude each other, and for no_folds where light does not fall from the
///        axis on a plane across it
Constraints read_constraints(const Settings& settings, double unit_mm, const Vector3& source_mm,
                             const sim::NearField& field);

}  // namespace catoptric::design
