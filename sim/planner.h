#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/photon_map.h"
#include "sim/scene.h"

namespace catoptric::sim {

/// How the light is computed, cheapest first.
enum class Rung { tubes, photons };
std::string_view name(Rung rung);

/// One feature of the scene, what it is here, and what follows for the model.
struct Finding {
  std::string feature, found, consequence;
};

/// What will be computed and why.
struct Plan {
  Rung rung = Rung::photons;
  std::vector<Finding> findings;
};

/// Picks the cheapest rung that is valid for the scene and the estimate it asks for, or checks the one that
/// the user wants.
/// @fails InputError when the wanted rung is not valid; it names the reason
/// @cost  that of tubes_objection
Plan make_plan(const Scene& scene, const EstimateOptions& estimate, std::optional<Rung> wanted);

}  // namespace catoptric::sim
