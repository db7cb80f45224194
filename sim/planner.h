#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/photon_map.h"
#include "sim/scene.h"

namespace catoptric::sim {

/// How the light is computed, cheapest first.
enum class Rung { tubes, rings, photons };
inline constexpr Rung all_rungs[] = {Rung::tubes, Rung::rings, Rung::photons};
std::string_view name(Rung rung);
std::optional<Rung> parse_rung(std::string_view name);

/// What is asked of the light besides the scene.
struct ModelRequest {
  EstimateOptions estimate;                ///< its bandwidth; neither is set where the program may choose it
  std::optional<Rung> rung = {};           ///< the one that the user wants; nothing: the planner's choice
  std::optional<std::string> engine = {};  ///< likewise of the intersection
};

/// One feature of the scene, what it is here, and what follows for the model.
struct Finding {
  std::string feature, found, consequence;
};

/// What will be computed and why.
struct Plan {
  Rung rung = Rung::photons;
  std::vector<Finding> findings;
};

/// Why a rung cannot give what is asked for, in words, or nothing. Photons can always.
/// @cost  that of tubes_objection
std::optional<std::string> rung_objection(Rung rung, const Scene& scene, const ModelRequest& request);

/// Picks the cheapest rung that is valid for the scene and the estimate it asks for, or checks the one that
/// the user wants; and says feature by feature what is modelled and what is left out.
/// @fails InputError when the wanted rung is not valid; it names the reason
Plan make_plan(const Scene& scene, const ModelRequest& request);

}  // namespace catoptric::sim
