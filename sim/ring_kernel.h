#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace catoptric::sim {

/// Weight of a photon by its distance in r^2, over the bandwidth: 1 - u^2 or (1 - u^2)^2, without the factor
/// that a boundary kernel finds for itself.
enum class RingKernel { epanechnikov, biweight };

/// Raw kernel at u in [-1, 1].
inline double ring_kernel(RingKernel kernel, double u) {
  const double rest = 1 - u * u;
  return kernel == RingKernel::biweight ? rest * rest : rest;
}

/// The polynomial that, times the kernel, sees every polynomial of a degree below the order exactly through
/// whatever part of the window lies inside the segment: 1 has the mean 1, u .. u^(order - 1) the mean 0.
/// Order 2 is the linear boundary kernel, which amid a segment is the plain kernel; order 4 the cubic one.
/// @from  Gasser & Mueller 1979; Jones 1993, Simple boundary correction for kernel density estimation;
///        Fan & Gijbels 1996 (local polynomials)
struct BoundaryPolynomial {
  std::array<double, 4> c{};
  double operator()(double u) const { return c[0] + u * (c[1] + u * (c[2] + u * c[3])); }
};

/// Moments of the kernel: the mean of u^j times kernel, j = 0 .. 6.
using RingMoments = std::array<double, 7>;

/// Moments over the part [low, high] of [-1, 1], by integration.
RingMoments moments_between(RingKernel kernel, double low, double high);

/// @in  moments of a kernel over a window with more than `order` points
BoundaryPolynomial boundary_polynomial(const RingMoments& moments, int order);

}  // namespace catoptric::sim
