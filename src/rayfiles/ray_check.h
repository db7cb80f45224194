#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "rayfiles/bounding_sphere.h"
#include "rayfiles/ray_set.h"

namespace catoptric::rayfiles {

/// How far a direction's length may be from 1: text with three decimals is not refused, a velocity is.
inline constexpr double direction_length_tolerance = 0.005;

/// How far the rays' fluxes may add up to something else than the header says, relative, before it is worth a
/// note.
inline constexpr double total_flux_tolerance = 0.001;

/// A rule that rays break: where the first of them stands, and how many there are.
struct RayFinding {
  ErrorParts parts;
  std::uint64_t count;
};

/// What all rays are together. Rays without flux have no place in it, but in least_flux and equal_flux.
struct RayStatistics {
  std::uint64_t lit = 0;          ///< rays with flux
  double total_flux = 0;          ///< sum over the rays, W or lm
  double least_flux = 0;          ///< of a ray
  double greatest_flux = 0;       ///< of a ray
  bool equal_flux = false;        ///< every ray has the same
  Vector3 lowest_mm, highest_mm;  ///< corners of the box around the start points
  Sphere sphere;                  ///< around the start points, at most some percent larger than the smallest
  Vector3 mean_direction;         ///< weighted by flux; shorter than 1 the more directions differ
  std::optional<double>
      total_deviation_rel;  ///< (sum - header's total) / header's total, where it has one above 0
};

struct RayCheck {
  RayStatistics statistics;          ///< of the rays without fault
  std::vector<RayFinding> findings;  ///< at most one for each rule
  std::vector<std::string> notes;    ///< the header's, and what is odd about the rays

  bool sound() const { return findings.empty(); }
};

/// Looks at all rays: numbers that are not finite, directions of no length or far from unit length, negative
/// flux, no flux at all; whether the fluxes add up to the header's total (a note: some programs do not look
/// at it).
/// @out   the same bits always; sums are in the file's order, compensated
/// @fails InputError when the file changes meanwhile
/// @cost  two passes over the file, O(1) memory
RayCheck check_rays(const RaySet& rays);

/// @fails InputError with the first finding: file, number of the ray, byte, field, rule
void require_sound(const RayCheck& check);

}  // namespace catoptric::rayfiles
