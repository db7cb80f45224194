#pragma once

#include <functional>
#include <span>
#include <vector>

namespace catoptric::sim {

/// Radii that lie together: indices of the first and of one past the last.
struct RadiusGroup {
  std::size_t first, end;
};

/// Cuts ascending radii where two neighbours are farther apart than `gap_mm`.
std::vector<RadiusGroup> groups_of(std::span<const double> radii_mm, double gap_mm);

/// Functions of the radius that are dear to compute and smooth but for a few places: the value of
/// `components` functions at each of some radii, radius after radius.
struct RadialFunction {
  std::size_t components = 1;
  std::function<void(std::span<const double> at_mm, std::span<double> values)> evaluate;
};

struct RadialValues {
  std::vector<double> values;  ///< radius after radius, as asked for
  std::vector<double> error;   ///< of each component: worst that interpolation may be off
};

/// The functions at many radii from their values at few.
///
/// Between two breaks a panel is interpolated at 9, 17 or 33 Chebyshev points; where 33 do not suffice it is
/// halved. Where a panel holds no more radii than points it needs, the functions are computed there.
/// @in    radii ascending; breaks ascending; allowed: an error for each component
/// @error twice the last quarter of the Chebyshev coefficients, which bounds what comes after them wherever
/// they
///        fall at least like k^-3 (a jump in the third derivative gives k^-4); and at least a sixty-fourth of
///        what the new half of the points says of the interpolant without them
/// @from  Trefethen 2013, ch. 4 and 7 (aliasing; algebraic rates)
RadialValues interpolate(const RadialFunction& function, std::span<const double> radii_mm,
                         std::span<const double> breaks_mm, double gap_mm, std::span<const double> allowed);

}  // namespace catoptric::sim
