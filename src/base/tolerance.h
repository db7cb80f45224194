#pragma once

#include "base/contract.h"

namespace catoptric {

/// The one place where tolerances are decided. Lengths scale with the part, so that a part a thousand times
/// larger gives the same answer; parameters and angles are relative by nature.
struct Tolerance {
  double length_mm;  ///< two points nearer than this are one: 1e-12 of the part, some 5000 roundings
  double lift_mm;    ///< a ray that leaves a surface ignores hits nearer than this along the ray: 1e-9 of the
                     ///< part, above the error of a start point seen at a grazing angle of 1e-6 rad
  double parameter;  ///< two parameters nearer than this (relative to the span) are one
  double angle_rad;  ///< two directions nearer than this are one
  double exchange_mm;  ///< how far a re-read file may be from what was written: 1e-9 of the part

  /// @in diagonal_mm  the part's largest extent, > 0 and finite
  static Tolerance for_scale(double diagonal_mm) {
    CATOPTRIC_EXPECTS(diagonal_mm > 0);
    return {1e-12 * diagonal_mm, 1e-9 * diagonal_mm, 1e-12, 1e-12, 1e-9 * diagonal_mm};
  }
};

/// Least weight of a control point that OCCT and our own spans evaluate to full precision.
inline constexpr double least_weight = 1e-8;
inline constexpr double greatest_weight = 1e8;

}  // namespace catoptric
