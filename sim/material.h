#pragma once

#include <algorithm>
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

/// The share of the light that goes on from a surface.
constexpr double surviving_share(const Material& material) {
  return std::min(1.0, material.reflectance + material.transmittance);
}

/// Whether light comes back from the surface.
constexpr bool reflects(const Material& material) { return material.reflectance > 0; }

/// Whether every photon that goes on from its first meeting with the mirror is reflected there.
constexpr bool reflects_for_certain(const Material& mirror) {
  return mirror.reflectance > 0 && !(mirror.transmittance > 0);
}

/// What becomes of a photon at its first meeting with the mirror. Every photon that is recorded has met it
/// once, so the share that survives there is the same for all: their power carries it (FlightTotals), and
/// chance is left with nothing but to reflect or transmit. A mirror that does only one of them needs no
/// chance at all, and evenly spread photons stay even.
/// @in    number: gives a uniform number when asked
template <typename Number>
Interaction first_interaction(const Material& mirror, const Number& number) {
  const double share = surviving_share(mirror);
  if (!(share > 0)) return Interaction::absorbed;
  if (reflects_for_certain(mirror)) return Interaction::reflected;
  if (!(mirror.reflectance > 0)) return Interaction::transmitted;
  return number() < mirror.reflectance / share ? Interaction::reflected : Interaction::transmitted;
}

/// What keeps these numbers from being a material, in words, or nothing.
std::optional<ErrorParts> find_defect(const Material& material);

}  // namespace catoptric::sim
