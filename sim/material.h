#pragma once

#include <algorithm>
#include <memory>
#include <optional>

#include "base/errors.h"
#include "sim/angular_reflectance.h"

namespace catoptric::sim {

/// What a surface does with the light that meets it, as shares of it; the rest is absorbed. It is alike on
/// both sides.
struct Material {
  double reflectance = 1.0;    ///< of the mirror-like lobe; the greatest where it goes with the angle
  double transmittance = 0.0;  ///< straight through
  double diffuse = 0.0;        ///< reflected by Lambert's law, into the side it came from
  double roughness = 0.0;      ///< alpha of the mirror-like lobe's GGX microfacets; 0: specular
  std::shared_ptr<const AngularReflectance> by_angle = {};  ///< course of the reflectance; nothing: level

  /// A surface that reflects by Lambert's law alone.
  static Material matt(double diffuse, double transmittance = 0) { return {0, transmittance, diffuse}; }
  /// A smooth mirror whose reflectance is linear between angles of incidence, as AngularReflectance::table.
  static Material with_table(std::vector<double> angles_rad, std::vector<double> reflectances);
  /// A smooth bare metal, as AngularReflectance::metal.
  static Material metal(double index, double extinction);

  /// The mirror-like lobe's reflectance at an incidence; of a rough one, on one of its microfacets.
  double reflectance_at(double cosine) const {
    return by_angle ? reflectance * by_angle->relative(cosine) : reflectance;
  }
  bool operator==(const Material& other) const;
};

/// Finer is no roughness: a mirror with it spreads light by less than any ray can tell.
inline constexpr double least_roughness = 1e-6;

/// What happens to one photon.
enum class Interaction { absorbed, reflected, transmitted };

/// The greatest share of the light that goes on from a surface, over all angles.
inline double surviving_share(const Material& material) {
  return std::min(1.0, material.reflectance + material.diffuse + material.transmittance);
}

/// Whether light goes back from it in any way.
inline bool reflects(const Material& material) { return material.reflectance > 0 || material.diffuse > 0; }

/// Whether light leaves it only mirrored or straight on, so that rays stay rays.
inline bool is_specular(const Material& material) {
  return !(material.diffuse > 0) && !(material.reflectance > 0 && material.roughness > 0);
}

/// Whether of all photons that meet it with surviving_share() of their power each goes on mirrored.
inline bool reflects_for_certain(const Material& mirror) {
  return mirror.reflectance > 0 && !(mirror.transmittance > 0) && is_specular(mirror) && !mirror.by_angle;
}

/// What keeps these numbers from being a material, in words, or nothing.
std::optional<ErrorParts> find_defect(const Material& material);

/// The ways in which light leaves a surface.
enum class Lobe { none, mirror, diffuse, through };

/// What chance has to decide of a photon at a surface.
enum class Roulette {
  all,        ///< whether it survives, and how
  survivors,  ///< how, and only what surviving_share() does not say: its power carries that share. Every
              ///< photon that is recorded has met the mirror once, so that share stands before all of them,
              ///< and evenly spread photons stay even
};

struct Choice {
  Lobe lobe;
  double number = 0;  ///< mirror, where it is rough: uniform in [0, reflectance). The photon goes on where
                      ///< what its microfacet reflects is more
};

/// Russian roulette between the lobes.
/// @in    cosine of the incidence; number: gives a uniform number when asked, which it is once at most, and
///        not where there is nothing to decide
/// @from  Arvo & Kirk 1990; paper section 4.4
template <typename Number>
Choice choose_lobe(const Material& material, Roulette roulette, double cosine, const Number& number) {
  const double mirror = material.reflectance, diffuse = material.diffuse, through = material.transmittance;
  const bool among_survivors = roulette == Roulette::survivors;
  const double share = among_survivors ? surviving_share(material) : 1;
  const bool level = !material.by_angle && !(material.roughness > 0);
  if (!(share > 0)) return {Lobe::none};
  if (level && (among_survivors ? reflects_for_certain(material) : mirror >= 1)) return {Lobe::mirror};
  if (among_survivors ? !(mirror > 0) && !(through > 0) : diffuse >= 1) return {Lobe::diffuse};
  if (among_survivors && !reflects(material)) return {Lobe::through};
  const double place = number();
  const auto mirrored = [&]() -> Choice {
    if (level) return {Lobe::mirror};
    if (material.roughness > 0) return {Lobe::mirror, place * share};
    return {place * share < material.reflectance_at(cosine) ? Lobe::mirror : Lobe::none};
  };
  if (place < mirror / share) return mirrored();
  if (place < (mirror + diffuse) / share) return {Lobe::diffuse};
  if (place < (mirror + diffuse + through) / share) return {Lobe::through};
  if (!among_survivors) return {Lobe::none};
  // Roundings of the shares left a sliver.
  return through > 0 ? Choice{Lobe::through} : diffuse > 0 ? Choice{Lobe::diffuse} : mirrored();
}

}  // namespace catoptric::sim
