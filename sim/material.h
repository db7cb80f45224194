#pragma once

#include <optional>

#include "base/errors.h"

namespace catoptric::sim {

/// What a surface does with the light that meets it, as probabilities of the Russian roulette; the rest is
/// absorbed.
struct Material {
  double reflectance = 1.0;    ///< in [0, 1]
  double transmittance = 0.0;  ///< in [0, 1], straight through; reflectance + transmittance <= 1
  bool operator==(const Material&) const = default;
};

/// What happens to one photon.
enum class Interaction { absorbed, reflected, transmitted };

/// Russian roulette: `number` is uniform in [0, 1).
/// @from  Arvo & Kirk 1990; paper section 4.4
constexpr Interaction roulette(const Material& material, double number) {
  if (number < material.reflectance) return Interaction::reflected;
  if (number < material.reflectance + material.transmittance) return Interaction::transmitted;
  return Interaction::absorbed;
}

/// What keeps these numbers from being a material, in words, or nothing.
std::optional<ErrorParts> find_defect(const Material& material);

}  // namespace catoptric::sim
