#pragma once

namespace catoptric::sim {

/// What a surface does with the light that meets it, as probabilities of the Russian roulette; the rest is
/// absorbed.
struct Material {
  double reflectance = 1.0;    ///< in [0, 1]
  double transmittance = 0.0;  ///< in [0, 1], straight through; reflectance + transmittance <= 1
};

}  // namespace catoptric::sim
