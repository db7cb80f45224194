#pragma once

#include <optional>
#include <string_view>

namespace catoptric::sim {

/// Weight of a photon by its distance from the estimate's point.
enum class Kernel { silverman, epanechnikov, cone, gaussian, constant };

/// K(t) for t = distance / radius in [0, 1], 0 beyond; normalised so that the mean of K over the disc is 1.
/// Silverman: 3 (1 - t^2)^2; Epanechnikov: 2 (1 - t^2); cone: 3 (1 - t); constant: 1; Gaussian: cut at t = 1
/// and normalised there.
/// @from  Silverman 1986 eq. 4.5; paper section 4.4; Jensen 2001 section 7.2 for the cone and Gaussian
/// filters
double kernel_value(Kernel kernel, double t);

std::string_view name(Kernel kernel);
std::optional<Kernel> parse_kernel(std::string_view name);

}  // namespace catoptric::sim
