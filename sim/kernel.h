#pragma once

#include <optional>
#include <string_view>

namespace catoptric::sim {

/// Weight of a photon by its distance from the estimate's point.
enum class Kernel { silverman, epanechnikov, cone, gaussian, constant };

/// K(t) for t = distance / radius in [0, 1], 0 beyond; normalised so that the mean of K over the disc is 1.
/// Silverman: 3 (1 - t^2)^2; Epanechnikov: 2 (1 - t^2); cone: 3 (1 - t); constant: 1; Gaussian: standard
/// deviation 1/3, cut at t = 1 and normalised there.
/// @from  Silverman 1986 eq. 4.5; paper section 4.4; Jensen 2001 section 7.2 for the cone and Gaussian
/// filters
double kernel_value(Kernel kernel, double t);

/// Mean of K^2 over the disc: with n photons spread evenly in the disc the relative noise of an estimate is
/// sqrt(this / n). Silverman 9/5, Epanechnikov 4/3, cone 3/2, constant 1, Gaussian 2.30.
double kernel_square_mean(Kernel kernel);

std::string_view name(Kernel kernel);
std::optional<Kernel> parse_kernel(std::string_view name);

}  // namespace catoptric::sim
