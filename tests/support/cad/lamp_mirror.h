#pragma once

#include <cmath>
#include <vector>

#include "base/units.h"
#include "cad/shape.h"
#include "support/quadrature.h"

namespace catoptric::test {

/// The paper's paraboloid, z = 100 mm - r^2 / 200 mm out to 100 mm, as a part to be made: an opening for the
/// lamp, a wall, a flange. By plain sums over its section, without a CAD kernel.
struct LampMirror {
  double opening_mm = 10, wall_mm = 1, flange_mm = 8, flange_thickness_mm = 2;

  cad::Wall wall() const {
    return {wall_mm, cad::WallSide::outside, cad::Flange{flange_mm, flange_thickness_mm}};
  }
  static double height(double r) { return 100 - r * r / 200; }
  /// Outer side over r of the optical surface.
  double back_r(double r) const { return r + wall_mm * (r / 100) / std::hypot(1, r / 100); }
  double back_z(double r) const { return height(r) + wall_mm / std::hypot(1, r / 100); }

  /// r of the optical surface whose outer side is as high as the flange: its own rim where the flange is
  /// lower than the edge.
  double flange_meets() const {
    double low = opening_mm, high = 100;
    if (back_z(high) >= 50 + flange_thickness_mm) return high;
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      (back_z(middle) >= 50 + flange_thickness_mm ? low : high) = middle;
    }
    return low;
  }

  double volume_mm3() const {
    return std::abs(around([](double r, double, double dz) { return pi * r * r * dz; }));
  }
  double area_mm2() const {
    return around([](double r, double dr, double dz) { return 2 * pi * r * std::hypot(dr, dz); });
  }

 private:
  /// Integral of what(r, dr, dz) along the section's outline: Pappus' and Gauss' theorems make area and
  /// volume of it.
  template <typename What>
  double around(const What& what) const {
    const double meets = flange_meets();
    double sum = integral(opening_mm, 100, 20, [&](double r) { return what(r, 1, -r / 100); });
    const auto straight = [&](double r0, double z0, double r1, double z1) {
      sum += integral(0, 1, 1, [&](double s) { return what(r0 + s * (r1 - r0), r1 - r0, z1 - z0); });
    };
    const double top = 50 + flange_thickness_mm, edge = 100 + flange_mm;
    double corner = back_r(meets);
    if (meets == 100) corner = 100 + (back_r(100) - 100) * flange_thickness_mm / (back_z(100) - 50);
    straight(100, 50, edge, 50);
    straight(edge, 50, edge, top);
    straight(edge, top, corner, top);
    if (meets == 100) straight(corner, top, back_r(100), back_z(100));
    sum += integral(opening_mm, meets, 20, [&](double s) {
      const double r = meets + opening_mm - s;  // inward
      const double q = 1 + r * r / 1e4, bend = wall_mm / 100 / (q * std::sqrt(q));
      return what(back_r(r), -(1 + bend), r / 100 * (1 + bend));
    });
    straight(back_r(opening_mm), back_z(opening_mm), opening_mm, height(opening_mm));
    return sum;
  }
};

}  // namespace catoptric::test
