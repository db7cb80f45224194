#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace catoptric {

/// Value of a polynomial in Bernstein form at s, by de Casteljau.
/// @error a few roundings of the largest coefficient for s in [0, 1]
/// @cost  O(degree^2)
double bernstein_value(std::span<const double> coefficients, double s);

/// Splits at s in [0, 1]: `left` receives the coefficients over [0, s], `right` those over [s, 1].
/// The shared end is the same double in both.
void bernstein_split(std::span<const double> coefficients, double s, std::vector<double>& left,
                     std::vector<double>& right);

/// Bernstein coefficients of the product of two polynomials; the degrees add.
/// @from  Farin, Curves and Surfaces for CAGD, 5th ed., section 5.9
std::vector<double> bernstein_product(std::span<const double> a, std::span<const double> b);

/// Binomial coefficient, exact for n <= 56.
double binomial(int n, int k);

}  // namespace catoptric
