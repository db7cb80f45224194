#pragma once

#include "base/ray.h"

namespace catoptric::sim {

/// A rough mirror of GGX microfacets, each a smooth mirror, with masking and shadowing by Smith's law,
/// heights correlated. Directions are in a frame whose z is the surface's normal; `from` points back to where
/// the light comes from and `to` where it goes, both unit with z > 0 (from: z >= 0). Light that meets a
/// second microfacet is lost: see README.md for how much.
/// @from  Walter, Marschner, Li & Torrance 2007; Heitz 2014 for the masking
class Microfacets {
 public:
  /// @in    alpha in [least_roughness, 1]
  explicit Microfacets(double alpha) : alpha_(alpha) {}

  /// The normal of a microfacet that light from there meets: probability in proportion to the area seen.
  /// @in    numbers uniform in [0, 1)
  /// @from  Heitz 2018, "Sampling the GGX Distribution of Visible Normals"
  Vector3 visible_normal(const Vector3& from, double first, double second) const;

  /// Of what a visible microfacet sends there, the share that no other one takes: G2 / G1.
  double unshadowed(const Vector3& from, const Vector3& to) const;

  /// Density of directions that mirroring at visible_normal gives, 1/sr. Over the whole sphere: some lie
  /// below the surface.
  double density(const Vector3& from, const Vector3& to) const;

  /// Reflectance distribution of perfect microfacets, 1/sr; 0 where `to` lies below the surface.
  /// @out   the same with `from` and `to` exchanged
  double distribution(const Vector3& from, const Vector3& to) const;

 private:
  /// Share of microfacets' area about a normal, 1/sr.
  double facets(const Vector3& normal) const;
  /// The cosine times sqrt(1 + alpha^2 tan^2), of which Smith's Lambda follows without a division.
  double stretched(const Vector3& direction) const;

  double alpha_;
};

}  // namespace catoptric::sim
