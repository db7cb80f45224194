#pragma once

#include "base/random_stream.h"
#include "base/ray.h"

namespace catoptric::sim {

/// What a body of glass is made of.
struct Glass {
  double index = 1.5;            ///< refractive, against the air around it
  double absorption_per_mm = 0;  ///< light falls like exp(-absorption * way) inside
  bool operator==(const Glass&) const = default;
};

/// Light at a polished face of a body of glass, before or after it.
struct GlassLight {
  Vector3 direction;   ///< unit
  bool inside;         ///< whether it goes through the glass
  bool along = false;  ///< inside: its field swings in the plane of incidence, else across it
};

/// What chance does with light that meets a face: it is thrown back by Fresnel's share, else refracted. Light
/// comes unpolarised and keeps, inside, the polarisation that it entered with: between parallel or concentric
/// faces all planes of incidence are one.
/// @in    outward: the face's normal, out of the glass; light that is inside goes with it, other against it
/// @out   one number is taken from `chance` for reflection unless that is total, one more for light that
/// enters
/// @from  Born & Wolf, Principles of Optics, section 1.5.3
GlassLight cross_face(const Glass& glass, const GlassLight& light, const Vector3& outward,
                      RandomStream& chance);

/// Share of the light that a way through the glass leaves.
double internal_transmittance(const Glass& glass, double way_mm);

}  // namespace catoptric::sim
