#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "design/settings.h"
#include "sim/surroundings.h"

namespace catoptric::design {

/// What is asked of one of the further fields.
struct FieldSpec {
  std::string name;
  std::size_t samples;
  std::optional<double> irradiance_w_per_mm2;  ///< wanted all over it; nothing: it is only reported
  double weight;                               ///< of its area in the objective, against the near field's
};

/// Fills in what keys of `objects` and `fields` leave out, and refuses what has no effect.
void complete_surroundings(Settings& settings);

/// The things about the mirror, and the fields besides the near field, in the order of their names.
/// @in    completed settings; kernel_radius: the near field's, where the estimate has one
/// @out   null where there is nothing
/// @fails InputError naming the key
std::shared_ptr<const sim::Surroundings> read_surroundings(const Settings& settings, double unit_mm);

/// What is wanted of the fields, in the same order.
std::vector<FieldSpec> read_fields(const Settings& settings);

}  // namespace catoptric::design
