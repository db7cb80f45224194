#include "sim/ring_kernel.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "base/contract.h"

namespace catoptric::sim {
namespace {

template <int Order>
BoundaryPolynomial solve(const RingMoments& moments) {
  Eigen::Matrix<double, Order, Order> gram;
  for (int i = 0; i < Order; ++i)
    for (int j = 0; j < Order; ++j) gram(i, j) = moments[static_cast<std::size_t>(i + j)];
  Eigen::Matrix<double, Order, 1> unit = Eigen::Matrix<double, Order, 1>::Unit(0);
  const Eigen::Matrix<double, Order, 1> found = gram.ldlt().solve(unit);
  BoundaryPolynomial polynomial;
  for (int i = 0; i < Order; ++i) polynomial.c[static_cast<std::size_t>(i)] = found(i);
  return polynomial;
}

}  // namespace

RingMoments moments_between(RingKernel kernel, double low, double high) {
  const auto to = [kernel](double u, int j) {
    const double power = std::pow(u, j + 1), square = u * u;
    if (kernel == RingKernel::epanechnikov) return power * (1.0 / (j + 1) - square / (j + 3));
    return power * (1.0 / (j + 1) - 2 * square / (j + 3) + square * square / (j + 5));
  };
  RingMoments moments{};
  for (int j = 0; j < 7; ++j) moments[static_cast<std::size_t>(j)] = to(high, j) - to(low, j);
  return moments;
}

BoundaryPolynomial boundary_polynomial(const RingMoments& moments, int order) {
  CATOPTRIC_EXPECTS(order == 2 || order == 4);
  return order == 2 ? solve<2>(moments) : solve<4>(moments);
}

}  // namespace catoptric::sim
